//! One page's WebSocket: a thread that reads its commands, and one that tells it what is new.

use std::io::{self, Read, Write};
use std::net::{Shutdown, TcpStream};
use std::sync::Arc;
use std::sync::mpsc::SyncSender;
use std::time::{Duration, Instant};

use tungstenite::handshake::derive_accept_key;
use tungstenite::protocol::frame::coding::CloseCode;
use tungstenite::protocol::{CloseFrame, Role, WebSocketConfig};
use tungstenite::{Error, Message, WebSocket};

use crate::command::{Command, MOST_BYTES};
use crate::http::hang_up;
use crate::hub::{Hub, Next, PageId, Seen};
use crate::server::Limits;
use crate::simulation::{Input, refused};

/// Grants the request for a WebSocket with this key and serves it until either side has enough.
pub fn serve(
    mut stream: TcpStream,
    (key, rest): (&str, Vec<u8>),
    (hub, inputs): (&Arc<Hub>, &SyncSender<Input>),
    limits: &Limits,
) -> io::Result<()> {
    let accept = derive_accept_key(key.as_bytes());
    let head = format!(
        "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n\
         Sec-WebSocket-Accept: {accept}\r\n\r\n"
    );
    stream.write_all(head.as_bytes())?;
    // a frame is small and late soon
    stream.set_nodelay(true)?;
    stream.set_read_timeout(Some(limits.silence))?;
    let (write, last) = (stream.try_clone()?, stream.try_clone()?);
    let page = hub.join();
    let writer = {
        let (hub, patience) = (Arc::clone(hub), limits.ping_after);
        std::thread::Builder::new()
            .name("page writer".to_owned())
            .spawn(move || tell(write, &hub, page, patience))
    };
    let farewell = match (&writer, inputs.send(Input::Joined)) {
        (Ok(_), Ok(())) => listen(stream, rest, page, (hub, inputs)),
        _ => None,
    };
    hub.dismiss(page, farewell);
    // a panic of the writer ends its page and nothing else
    let _ = writer.map(|writer| writer.join());
    hub.leave(page);
    hang_up(last, Duration::from_millis(500));
    Ok(())
}

fn config() -> WebSocketConfig {
    WebSocketConfig::default()
        .read_buffer_size(8 << 10)
        .write_buffer_size(0)
        .max_message_size(Some(MOST_BYTES))
        .max_frame_size(Some(MOST_BYTES))
}

/// Hands the page's commands to the simulation until it has no more; what to say at the end.
fn listen(
    stream: TcpStream,
    rest: Vec<u8>,
    page: PageId,
    (hub, inputs): (&Hub, &SyncSender<Input>),
) -> Option<CloseFrame> {
    let mut socket =
        WebSocket::from_partially_read(ReadOnly(stream), rest, Role::Server, Some(config()));
    loop {
        match socket.read() {
            Ok(Message::Text(text)) => match Command::parse(&text) {
                // when too many commands wait, the page waits too
                Ok(command) => inputs.send(Input::Said { page, command }).ok()?,
                Err(why) => hub.answer(page, refused(&why)),
            },
            Ok(Message::Binary(_)) => {
                hub.answer(page, refused("this is no command: commands are text"));
            }
            Ok(Message::Ping(data)) => hub.answer(page, Message::Pong(data)),
            Ok(Message::Pong(_) | Message::Frame(_)) => {}
            Ok(Message::Close(farewell)) => return farewell,
            Err(Error::Capacity(_)) => {
                let reason = format!("a message may have at most {MOST_BYTES} bytes").into();
                return Some(CloseFrame { code: CloseCode::Size, reason });
            }
            Err(Error::Protocol(_) | Error::Utf8(_)) => {
                let reason = "this is no WebSocket message".into();
                return Some(CloseFrame { code: CloseCode::Protocol, reason });
            }
            // gone, or silent for too long
            Err(_) => return None,
        }
    }
}

/// Tells the page what is new until it is gone or takes nothing any more.
fn tell(stream: TcpStream, hub: &Hub, page: PageId, patience: Duration) {
    let Ok(shut) = stream.try_clone() else { return };
    let mut socket = WebSocket::from_raw_socket(stream, Role::Server, Some(config()));
    let mut seen = Seen::default();
    let mut ping_at = Instant::now() + patience;
    loop {
        let quiet = ping_at.saturating_duration_since(Instant::now());
        // a page that only looks says nothing by itself, but it answers
        let message = if quiet.is_zero() {
            ping_at += patience;
            Next::Send(Message::Ping(Default::default()))
        } else {
            hub.next(page, &mut seen, quiet)
        };
        let message = match message {
            Next::Send(message) => message,
            Next::Nothing => continue,
            Next::Farewell(farewell) => {
                let _ = socket.close(farewell);
                let _ = socket.flush();
                // wakes the reader, if it still reads
                let _ = shut.shutdown(Shutdown::Read);
                return;
            }
        };
        if socket.send(message).is_err() {
            let _ = shut.shutdown(Shutdown::Both);
            return;
        }
    }
}

/// The reader's end. What the protocol wants answered is handed to the writer, so that two threads never
/// write over each other; what the reader's own socket would write goes nowhere.
#[derive(Debug)]
struct ReadOnly(TcpStream);

impl Read for ReadOnly {
    fn read(&mut self, room: &mut [u8]) -> io::Result<usize> {
        self.0.read(room)
    }
}

impl Write for ReadOnly {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
