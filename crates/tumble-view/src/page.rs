//! The page that the server hands out.

/// The live page: a stand-in that shows the time, until the page of the viewer takes its place.
pub fn live_html() -> String {
    PLACEHOLDER.to_owned()
}

const PLACEHOLDER: &str = r#"<!doctype html><meta charset="utf-8"><title>tumble</title>
<pre id="said">connecting …</pre>
<script>
const said = document.getElementById("said");
const socket = new WebSocket("ws://" + location.host + "/live");
socket.binaryType = "arraybuffer";
socket.onmessage = ({ data }) => {
  if (typeof data === "string") console.log(data.slice(0, 1000));
  else said.textContent = "t = " + new DataView(data).getFloat64(0, true).toFixed(3) + " s";
};
socket.onclose = () => { said.textContent = "the server is gone"; };
</script>
"#;
