//! The server: accepts connections on the loopback interface and routes requests.

use std::io;
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread::{Builder, JoinHandle};
use std::time::{Duration, Instant};

use tumble_io::page::live_html;

use crate::broadcast::Broadcast;
use crate::http::{self, Refusal, Request};
use crate::limits::Limits;
use crate::simulation::{Event, QUEUE_CAPACITY, simulate};
use crate::{Session, socket};

/// The default port.
const PORT: u16 = 8642;
/// Number of ports tried when none is given.
const PORT_COUNT: u16 = 10;

/// What the server shows.
#[derive(Debug)]
pub enum Content {
    /// A running simulation.
    Live(Box<Session>),
    /// A complete page, such as the `motion.html` of a run.
    Page(Vec<u8>),
}

/// A server that runs until it is closed.
#[derive(Debug)]
pub struct Server {
    shared: Arc<Shared>,
    events: Option<SyncSender<Event>>,
    threads: Vec<JoinHandle<()>>,
}

#[derive(Debug)]
struct Shared {
    address: SocketAddr,
    limits: Limits,
    page: Vec<u8>,
    broadcast: Arc<Broadcast>,
    connections: AtomicUsize,
    is_closing: AtomicBool,
}

impl Server {
    /// Binds a port of the loopback interface, which can be reached from this machine only. Port 0 stands for any
    /// free port. Without a port, the first free one from 8642 on is taken.
    ///
    /// # Errors
    /// When the port cannot be bound.
    pub fn bind(port: Option<u16>) -> io::Result<TcpListener> {
        let bind = |port| TcpListener::bind((Ipv4Addr::LOCALHOST, port));
        let Some(port) = port else {
            let mut results = (PORT..PORT + PORT_COUNT).map(bind);
            let in_use = |result: &io::Result<TcpListener>| matches!(result, Err(error) if error.kind() == io::ErrorKind::AddrInUse);
            return results.find(|result| !in_use(result)).unwrap_or_else(|| bind(0));
        };
        bind(port)
    }

    /// Starts the server and, for live content, the simulation.
    ///
    /// # Errors
    /// When a thread cannot be started.
    pub fn start(content: Content, listener: TcpListener, limits: Limits) -> io::Result<Self> {
        let (page, session) = match content {
            Content::Live(session) => (live_html().into_bytes(), Some(session)),
            Content::Page(page) => (page, None),
        };
        let shared = Arc::new(Shared {
            address: listener.local_addr()?,
            limits,
            page,
            broadcast: Arc::new(Broadcast::default()),
            connections: AtomicUsize::new(0),
            is_closing: AtomicBool::new(false),
        });
        let mut server = Self { shared, events: None, threads: Vec::new() };
        if let Some(session) = session {
            let (sender, receiver) = sync_channel(QUEUE_CAPACITY);
            let broadcast = Arc::clone(&server.shared.broadcast);
            let simulation = move || simulate(*session, &broadcast, &receiver);
            server.threads.push(Builder::new().name("simulation".to_owned()).spawn(simulation)?);
            server.events = Some(sender);
        }
        let (shared, events) = (Arc::clone(&server.shared), server.events.clone());
        let accept = move || accept(&listener, &shared, events.as_ref());
        server.threads.push(Builder::new().name("accept".to_owned()).spawn(accept)?);
        Ok(server)
    }

    /// The port that the server listens on.
    pub fn port(&self) -> u16 {
        self.shared.address.port()
    }

    /// Whether all threads of the server are running.
    pub fn is_running(&self) -> bool {
        !self.threads.iter().any(JoinHandle::is_finished)
    }

    /// Closes all connections and stops the server. Returns false if one of its threads has panicked.
    pub fn close(self) -> bool {
        let Self { shared, events, threads } = self;
        shared.is_closing.store(true, Ordering::SeqCst);
        shared.broadcast.close();
        // fails if the simulation thread has already ended
        let _ = events.map(|events| events.send(Event::Shutdown));
        // unblocks the accept thread
        let _ = TcpStream::connect(shared.address);
        let is_ok = threads.into_iter().map(JoinHandle::join).all(|result| result.is_ok());
        let deadline = Instant::now() + Duration::from_millis(500);
        while shared.connections.load(Ordering::SeqCst) > 0 && Instant::now() < deadline {
            std::thread::sleep(Duration::from_millis(5));
        }
        is_ok
    }
}

/// Accepts connections until the server closes, each on its own thread.
fn accept(listener: &TcpListener, shared: &Arc<Shared>, events: Option<&SyncSender<Event>>) {
    for stream in listener.incoming() {
        if shared.is_closing.load(Ordering::SeqCst) {
            return;
        }
        let Ok(stream) = stream else {
            // too many open files, for instance: try again
            std::thread::sleep(Duration::from_millis(50));
            continue;
        };
        let _ = stream.set_write_timeout(Some(shared.limits.write_timeout));
        let Some(slot) = Slot::acquire(shared) else {
            reject(stream, shared.address.port());
            continue;
        };
        let events = events.cloned();
        let serve = move || serve(stream, &slot.0, events.as_ref());
        // if the thread cannot be started, the connection is closed and its slot released
        let _ = Builder::new().name("connection".to_owned()).spawn(serve);
    }
}

/// Answers that there are too many connections, without blocking the accept thread for long.
fn reject(stream: TcpStream, port: u16) {
    let reason = "too many pages are open; close one\n";
    let head = http::response_head(503, port, "text/plain", reason.len());
    let mut stream = stream;
    let _ = stream.set_nonblocking(true);
    let _ = io::Write::write(&mut stream, [head.as_bytes(), reason.as_bytes()].concat().as_slice());
    let _ = stream.set_nonblocking(false);
    http::shut_down(stream, Duration::from_millis(20));
}

/// One of the limited number of connections, released when dropped.
struct Slot(Arc<Shared>);

impl Slot {
    fn acquire(shared: &Arc<Shared>) -> Option<Self> {
        let in_use = shared.connections.fetch_add(1, Ordering::SeqCst);
        let slot = Self(Arc::clone(shared));
        (in_use < shared.limits.max_connections).then_some(slot)
    }
}

impl Drop for Slot {
    fn drop(&mut self) {
        self.0.connections.fetch_sub(1, Ordering::SeqCst);
    }
}

/// Serves one connection: a single request, which may become a WebSocket.
fn serve(mut stream: TcpStream, shared: &Shared, events: Option<&SyncSender<Event>>) {
    let port = shared.address.port();
    let request = match Request::read(&mut stream, shared.limits.request_timeout) {
        Ok(request) => request,
        Err(Some(refusal)) => return http::refuse(stream, port, &refusal),
        Err(None) => return,
    };
    match route(&request, port, events.is_some()) {
        Err(refusal) => http::refuse(stream, port, &refusal),
        Ok(Route::Page) => {
            let head = http::response_head(200, port, "text/html", shared.page.len());
            let body = if request.method == "HEAD" { &[] } else { shared.page.as_slice() };
            http::respond(stream, &head, body);
        }
        Ok(Route::Live(key)) => {
            if let Some(events) = events {
                let handshake = (key, request.rest.clone());
                // a page that disconnects at any time is not an error
                let _ =
                    socket::serve(stream, handshake, (&shared.broadcast, events), &shared.limits);
            }
        }
    }
}

enum Route<'a> {
    Page,
    /// A WebSocket, with its key.
    Live(&'a str),
}

/// The route of a request. Its path is compared with two constants and never used to open a file.
fn route(request: &Request, port: u16, is_live: bool) -> Result<Route<'_>, Refusal> {
    request.check_same_origin(port)?;
    match (request.method.as_str(), request.path.as_str()) {
        ("GET" | "HEAD", "/") => Ok(Route::Page),
        ("GET", "/live") if is_live => Ok(Route::Live(request.websocket_key()?)),
        ("GET" | "HEAD", _) => Err(Refusal { status: 404, reason: "not found".to_owned() }),
        _ => Err(Refusal { status: 405, reason: "only GET and HEAD are allowed".to_owned() }),
    }
}
