//! The server: who may come in, and what they find.

use std::io;
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread::{Builder, JoinHandle};
use std::time::{Duration, Instant};

use tumble_io::page::live_html;

use crate::http::{self, Refusal, Request};
use crate::hub::Hub;
use crate::simulation::{Input, MOST_WAITING, simulate};
use crate::{Session, socket};

/// The port of the viewer, where it is free.
const PORT: u16 = 8642;
/// How many ports after it are tried.
const MORE_PORTS: u16 = 10;

/// What the server shows.
#[derive(Debug)]
pub enum Show {
    /// A simulation on its way.
    Live(Box<Session>),
    /// A page that needs nothing more: that of a run.
    Page(Vec<u8>),
}

/// How patient the server is.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Time for a request to arrive whole.
    pub head_time: Duration,
    /// Time for a page to take anything at all of what is sent to it.
    pub write_time: Duration,
    /// So often a page is asked whether it is there.
    pub ping_after: Duration,
    /// After this long without a word or an answer of it, it is not.
    pub silence: Duration,
    /// How many connections there may be at a time.
    pub connections: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            head_time: Duration::from_secs(5),
            write_time: Duration::from_secs(10),
            ping_after: Duration::from_secs(20),
            silence: Duration::from_secs(90),
            connections: 32,
        }
    }
}

/// A server that runs until it is closed.
#[derive(Debug)]
pub struct Server {
    shared: Arc<Shared>,
    inputs: Option<SyncSender<Input>>,
    threads: Vec<JoinHandle<()>>,
}

#[derive(Debug)]
struct Shared {
    address: SocketAddr,
    limits: Limits,
    page: Vec<u8>,
    hub: Arc<Hub>,
    connections: AtomicUsize,
    is_closing: AtomicBool,
}

impl Server {
    /// Takes a port of the loopback interface, which only this machine reaches: `port`, any free one for 0,
    /// or without one the viewer's own or the next that is free.
    ///
    /// # Errors
    /// When it cannot be had.
    pub fn bind(port: Option<u16>) -> io::Result<TcpListener> {
        let bind = |port| TcpListener::bind((Ipv4Addr::LOCALHOST, port));
        let Some(port) = port else {
            let mut ports = (PORT..PORT + MORE_PORTS).map(bind);
            let taken = |result: &io::Result<TcpListener>| matches!(result, Err(error) if error.kind() == io::ErrorKind::AddrInUse);
            return ports.find(|result| !taken(result)).unwrap_or_else(|| bind(0));
        };
        bind(port)
    }

    /// Starts to serve.
    ///
    /// # Errors
    /// When the system has no thread to give.
    pub fn start(show: Show, listener: TcpListener, limits: Limits) -> io::Result<Self> {
        let (page, session) = match show {
            Show::Live(session) => (live_html().into_bytes(), Some(session)),
            Show::Page(page) => (page, None),
        };
        let shared = Arc::new(Shared {
            address: listener.local_addr()?,
            limits,
            page,
            hub: Arc::new(Hub::default()),
            connections: AtomicUsize::new(0),
            is_closing: AtomicBool::new(false),
        });
        let mut server = Self { shared, inputs: None, threads: Vec::new() };
        if let Some(session) = session {
            let (sender, receiver) = sync_channel(MOST_WAITING);
            let hub = Arc::clone(&server.shared.hub);
            let simulation = move || simulate(*session, &hub, &receiver);
            server.threads.push(Builder::new().name("simulation".to_owned()).spawn(simulation)?);
            server.inputs = Some(sender);
        }
        let (shared, inputs) = (Arc::clone(&server.shared), server.inputs.clone());
        let accept = move || accept(&listener, &shared, inputs.as_ref());
        server.threads.push(Builder::new().name("door".to_owned()).spawn(accept)?);
        Ok(server)
    }

    /// The port it serves.
    pub fn port(&self) -> u16 {
        self.shared.address.port()
    }

    /// Whether all of it is still there.
    pub fn is_running(&self) -> bool {
        !self.threads.iter().any(JoinHandle::is_finished)
    }

    /// Says goodbye to all pages and ends. True when everything ended well.
    pub fn close(self) -> bool {
        let Self { shared, inputs, threads } = self;
        shared.is_closing.store(true, Ordering::SeqCst);
        shared.hub.close();
        // the simulation may be gone already
        let _ = inputs.map(|inputs| inputs.send(Input::Close));
        // the door is waiting for somebody to come
        let _ = TcpStream::connect(shared.address);
        let well = threads.into_iter().map(JoinHandle::join).all(|ended| ended.is_ok());
        let deadline = Instant::now() + Duration::from_millis(500);
        while shared.connections.load(Ordering::SeqCst) > 0 && Instant::now() < deadline {
            std::thread::sleep(Duration::from_millis(5));
        }
        well
    }
}

/// Lets connections in, each with a thread of its own, until the server closes.
fn accept(listener: &TcpListener, shared: &Arc<Shared>, inputs: Option<&SyncSender<Input>>) {
    for stream in listener.incoming() {
        if shared.is_closing.load(Ordering::SeqCst) {
            return;
        }
        let Ok(stream) = stream else {
            // out of files, perhaps: that may pass
            std::thread::sleep(Duration::from_millis(50));
            continue;
        };
        let _ = stream.set_write_timeout(Some(shared.limits.write_time));
        let Some(seat) = Seat::take(shared) else {
            turn_away(stream, shared.address.port());
            continue;
        };
        let inputs = inputs.cloned();
        let serve = move || serve(stream, &seat.0, inputs.as_ref());
        // without a thread the connection is dropped, and its seat with it
        let _ = Builder::new().name("connection".to_owned()).spawn(serve);
    }
}

/// Too many are here already. This must not keep the next from coming in.
fn turn_away(stream: TcpStream, port: u16) {
    let why = "too many pages are open; close one\n";
    let head = http::response_head(503, port, "text/plain", why.len());
    let mut stream = stream;
    let _ = stream.set_nonblocking(true);
    let _ = io::Write::write(&mut stream, [head.as_bytes(), why.as_bytes()].concat().as_slice());
    let _ = stream.set_nonblocking(false);
    http::hang_up(stream, Duration::from_millis(20));
}

/// The right to a connection, given back when dropped.
struct Seat(Arc<Shared>);

impl Seat {
    fn take(shared: &Arc<Shared>) -> Option<Self> {
        let taken = shared.connections.fetch_add(1, Ordering::SeqCst);
        let seat = Self(Arc::clone(shared));
        (taken < shared.limits.connections).then_some(seat)
    }
}

impl Drop for Seat {
    fn drop(&mut self) {
        self.0.connections.fetch_sub(1, Ordering::SeqCst);
    }
}

/// One connection: one request, and what comes of it.
fn serve(mut stream: TcpStream, shared: &Shared, inputs: Option<&SyncSender<Input>>) {
    let port = shared.address.port();
    let request = match Request::read(&mut stream, shared.limits.head_time) {
        Ok(request) => request,
        Err(Some(refusal)) => return http::refuse(stream, port, &refusal),
        Err(None) => return,
    };
    match route(&request, port, inputs.is_some()) {
        Err(refusal) => http::refuse(stream, port, &refusal),
        Ok(Route::Page) => {
            let head = http::response_head(200, port, "text/html", shared.page.len());
            let body = if request.method == "HEAD" { &[] } else { shared.page.as_slice() };
            http::respond(stream, &head, body);
        }
        Ok(Route::Live(key)) => {
            if let Some(inputs) = inputs {
                // a page that goes away in the middle of a word is no failure
                let from = (key, request.rest.clone());
                let _ = socket::serve(stream, from, (&shared.hub, inputs), &shared.limits);
            }
        }
    }
}

enum Route<'a> {
    Page,
    Live(&'a str),
}

/// Where a request leads. Its path is compared with two names and used for nothing else.
fn route(request: &Request, port: u16, is_live: bool) -> Result<Route<'_>, Refusal> {
    request.is_from_here(port)?;
    match (request.method.as_str(), request.path.as_str()) {
        ("GET" | "HEAD", "/") => Ok(Route::Page),
        ("GET", "/live") if is_live => Ok(Route::Live(request.websocket_key()?)),
        ("GET" | "HEAD", _) => {
            Err(Refusal { status: 404, why: "there is nothing here".to_owned() })
        }
        _ => Err(Refusal { status: 405, why: "only GET and HEAD are answered".to_owned() }),
    }
}
