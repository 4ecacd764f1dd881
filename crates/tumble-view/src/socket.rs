//! The WebSocket of one page: one thread reads its commands, one writes to it.

use std::io::{self, Read, Write};
use std::net::{Shutdown, TcpStream};
use std::sync::Arc;
use std::sync::mpsc::SyncSender;
use std::time::{Duration, Instant};

use tungstenite::handshake::derive_accept_key;
use tungstenite::protocol::frame::coding::CloseCode;
use tungstenite::protocol::{CloseFrame, Role, WebSocketConfig};
use tungstenite::{Error, Message, WebSocket};

use crate::broadcast::{Broadcast, Outgoing, PageId, Received};
use crate::command::{Command, MAX_MESSAGE_BYTES};
use crate::http::shut_down;
use crate::limits::Limits;
use crate::simulation::{Event, refusal};

/// Accepts the WebSocket request with this key, whose first bytes after the head are `rest`, and serves the page
/// until either side closes the connection.
///
/// # Errors
/// When the stream fails during the handshake.
pub fn serve(
    mut stream: TcpStream,
    (key, rest): (&str, Vec<u8>),
    (broadcast, events): (&Arc<Broadcast>, &SyncSender<Event>),
    limits: &Limits,
) -> io::Result<()> {
    let accept = derive_accept_key(key.as_bytes());
    let head = format!(
        "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n\
         Sec-WebSocket-Accept: {accept}\r\n\r\n"
    );
    stream.write_all(head.as_bytes())?;
    // small frames must not wait for more data
    stream.set_nodelay(true)?;
    stream.set_read_timeout(Some(limits.idle_timeout))?;
    let (write_half, last) = (stream.try_clone()?, stream.try_clone()?);
    let page = broadcast.add_page();
    let writer = {
        let (broadcast, ping_interval) = (Arc::clone(broadcast), limits.ping_interval);
        std::thread::Builder::new()
            .name("page writer".to_owned())
            .spawn(move || write_messages(write_half, &broadcast, page, ping_interval))
    };
    let close = match (&writer, events.send(Event::Connected)) {
        (Ok(_), Ok(())) => read_commands(stream, rest, page, (broadcast, events)),
        _ => None,
    };
    broadcast.close_page(page, close);
    // a panic in the writer ends only this connection
    let _ = writer.map(|writer| writer.join());
    broadcast.remove_page(page);
    shut_down(last, Duration::from_millis(500));
    Ok(())
}

fn config() -> WebSocketConfig {
    WebSocketConfig::default()
        .read_buffer_size(8 << 10)
        .write_buffer_size(0)
        .max_message_size(Some(MAX_MESSAGE_BYTES))
        .max_frame_size(Some(MAX_MESSAGE_BYTES))
}

/// Passes the page's commands to the simulation until the connection ends. Returns the close frame to send.
fn read_commands(
    stream: TcpStream,
    rest: Vec<u8>,
    page: PageId,
    (broadcast, events): (&Broadcast, &SyncSender<Event>),
) -> Option<CloseFrame> {
    let mut socket =
        WebSocket::from_partially_read(ReadOnly(stream), rest, Role::Server, Some(config()));
    loop {
        match socket.read() {
            Ok(Message::Text(text)) => match Command::parse(&text) {
                // blocks while the queue is full, which slows the page down
                Ok(command) => events.send(Event::Command { page, command }).ok()?,
                Err(reason) => broadcast.reply(page, refusal(&reason)),
            },
            Ok(Message::Binary(_)) => {
                broadcast.reply(page, refusal("not a command: commands are text messages"));
            }
            Ok(Message::Ping(data)) => broadcast.reply(page, Message::Pong(data)),
            Ok(Message::Pong(_) | Message::Frame(_)) => {}
            Ok(Message::Close(close)) => return close,
            Err(Error::Capacity(_)) => {
                let reason = format!("a message may have at most {MAX_MESSAGE_BYTES} bytes").into();
                return Some(CloseFrame { code: CloseCode::Size, reason });
            }
            Err(Error::Protocol(_) | Error::Utf8(_)) => {
                let reason = "not a WebSocket message".into();
                return Some(CloseFrame { code: CloseCode::Protocol, reason });
            }
            // disconnected, or idle for too long
            Err(_) => return None,
        }
    }
}

/// Sends messages to the page until the connection ends.
fn write_messages(stream: TcpStream, broadcast: &Broadcast, page: PageId, ping_interval: Duration) {
    let Ok(handle) = stream.try_clone() else { return };
    let mut socket = WebSocket::from_raw_socket(stream, Role::Server, Some(config()));
    let mut received = Received::default();
    let mut next_ping = Instant::now() + ping_interval;
    loop {
        let to_ping = next_ping.saturating_duration_since(Instant::now());
        // a page without input sends nothing but pongs; they keep the connection from being idle
        let outgoing = if to_ping.is_zero() {
            next_ping += ping_interval;
            Outgoing::Message(Message::Ping(Default::default()))
        } else {
            broadcast.wait(page, &mut received, to_ping)
        };
        let message = match outgoing {
            Outgoing::Message(message) => message,
            Outgoing::TimedOut => continue,
            Outgoing::Close(close) => {
                let _ = socket.close(close);
                let _ = socket.flush();
                // unblocks the reader
                let _ = handle.shutdown(Shutdown::Read);
                return;
            }
        };
        if socket.send(message).is_err() {
            let _ = handle.shutdown(Shutdown::Both);
            return;
        }
    }
}

/// A stream whose writes are discarded.
///
/// The reader's `WebSocket` would answer pings and close frames by itself. Two threads must not write to one
/// connection, so those answers are queued for the writer thread instead.
#[derive(Debug)]
struct ReadOnly(TcpStream);

impl Read for ReadOnly {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.0.read(buffer)
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
