//! A web server on the loopback that answers range requests for one file, or says what it is told to say.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread::JoinHandle;
use std::time::Duration;

/// Serves until it is dropped, one connection after the other.
pub struct Server {
    address: SocketAddr,
    pub requests: Arc<AtomicU64>,
    pub bytes: Arc<AtomicU64>,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

/// What was asked for.
#[derive(Debug, Default)]
pub struct Request {
    /// How many there were before it.
    pub number: u64,
    pub path: String,
    /// First and last byte.
    pub range: Option<[usize; 2]>,
    pub if_range: Option<String>,
}

/// The head without its end, and the body.
pub type Answer = (String, Vec<u8>);

impl Server {
    /// Serves `file` with an ETag.
    pub fn start(file: Vec<u8>) -> Self {
        let bytes = Arc::<AtomicU64>::default();
        let sent = bytes.clone();
        let mut server = Self::with(move |request, stream| {
            let (head, body) = answer(&request, &file, "\"1\"");
            // Before they are sent: whoever has them may ask at once how many there were.
            sent.fetch_add(body.len() as u64, Ordering::Relaxed);
            send(stream, &head, &body);
        });
        server.bytes = bytes;
        server
    }

    /// Lets `respond` answer every request. The connection is closed after it.
    pub fn with(mut respond: impl FnMut(Request, &mut TcpStream) + Send + 'static) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = listener.local_addr().unwrap();
        let requests = Arc::<AtomicU64>::default();
        let stop = Arc::<AtomicBool>::default();
        let (count, stopped) = (requests.clone(), stop.clone());
        let thread = std::thread::spawn(move || {
            while let Ok((mut stream, _)) = listener.accept() {
                if stopped.load(Ordering::Relaxed) {
                    break;
                }
                let Some(mut request) = read(&stream) else {
                    continue;
                };
                request.number = count.fetch_add(1, Ordering::Relaxed);
                respond(request, &mut stream);
            }
        });
        Self {
            address,
            requests,
            bytes: Arc::default(),
            stop,
            thread: Some(thread),
        }
    }

    pub fn url(&self) -> String {
        format!("http://{}/model.welkin", self.address)
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        // A connection wakes the thread.
        let woken = TcpStream::connect(self.address).is_ok();
        if let (true, Some(thread)) = (woken, self.thread.take()) {
            let _ = thread.join();
        }
    }
}

/// A request; none where the other side says nothing for a while or breaks off.
fn read(stream: &TcpStream) -> Option<Request> {
    stream.set_read_timeout(Some(Duration::from_secs(5))).ok()?;
    stream
        .set_write_timeout(Some(Duration::from_secs(5)))
        .ok()?;
    let mut request = Request::default();
    let mut lines = BufReader::new(stream.take(16 << 10)).lines();
    let first = lines.next()?.ok()?;
    request.path = first.split(' ').nth(1)?.to_owned();
    for line in lines {
        let line = line.ok()?;
        if line.is_empty() {
            return Some(request);
        }
        let (name, value) = line.split_once(": ")?;
        match name.to_ascii_lowercase().as_str() {
            "range" => {
                let (first, last) = value.strip_prefix("bytes=")?.split_once('-')?;
                request.range = Some([first.parse().ok()?, last.parse().ok()?]);
            }
            "if-range" => request.if_range = Some(value.to_owned()),
            _ => {}
        }
    }
    None
}

/// The honest answer where `file` is of the version `tag`.
pub fn answer(request: &Request, file: &[u8], tag: &str) -> Answer {
    let current = request.if_range.as_ref().is_none_or(|t| t == tag);
    let head = |status: &str, more: &str, length: usize| {
        format!("HTTP/1.1 {status}\r\nETag: {tag}\r\n{more}Content-Length: {length}\r\n")
    };
    let Some([first, last]) = request.range.filter(|_| current) else {
        return (head("200 OK", "", file.len()), file.to_vec());
    };
    let body = &file[first.min(file.len())..last.saturating_add(1).min(file.len())];
    if body.is_empty() {
        let more = format!("Content-Range: bytes */{}\r\n", file.len());
        return (head("416 Range Not Satisfiable", &more, 0), vec![]);
    }
    let end = first + body.len() - 1;
    let more = format!("Content-Range: bytes {first}-{end}/{}\r\n", file.len());
    (
        head("206 Partial Content", &more, body.len()),
        body.to_vec(),
    )
}

/// Sends an answer; that the other side has gone is its own affair.
pub fn send(stream: &mut TcpStream, head: &str, body: &[u8]) {
    let _ = stream
        .write_all(format!("{head}Connection: close\r\n\r\n").as_bytes())
        .and_then(|()| stream.write_all(body));
}
