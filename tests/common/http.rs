//! A web server on the loopback that answers range requests for one file, and a client for it.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use welkin::ReadAt;

/// Serves `file` until the process ends.
pub struct Server {
    pub address: SocketAddr,
    pub requests: Arc<AtomicU64>,
    pub bytes: Arc<AtomicU64>,
}

impl Server {
    pub fn start(file: Vec<u8>) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let server = Self {
            address: listener.local_addr().unwrap(),
            requests: Arc::default(),
            bytes: Arc::default(),
        };
        let (requests, bytes) = (server.requests.clone(), server.bytes.clone());
        std::thread::spawn(move || {
            for stream in listener.incoming() {
                let mut stream = stream.unwrap();
                let (head, body) = answer(&stream, &file);
                // Before they are sent: whoever has them may ask at once how many there were.
                requests.fetch_add(1, Ordering::Relaxed);
                bytes.fetch_add(body.len() as u64, Ordering::Relaxed);
                stream.write_all(head.as_bytes()).unwrap();
                stream.write_all(body).unwrap();
            }
        });
        server
    }
}

/// Head and body of the answer to a request.
fn answer<'a>(stream: &TcpStream, file: &'a [u8]) -> (String, &'a [u8]) {
    let mut range = None;
    let reader = BufReader::new(stream);
    for line in reader.lines().map_while(Result::ok) {
        if let Some(value) = line.strip_prefix("Range: bytes=") {
            let (first, last) = value.split_once('-').unwrap();
            range = Some([first, last].map(|n| n.parse::<usize>().unwrap()));
        }
        if line.is_empty() {
            break;
        }
    }
    let [first, last] = range.expect("a range");
    let body = &file[first.min(file.len())..(last + 1).min(file.len())];
    let status = match body.is_empty() {
        true => "416 Range Not Satisfiable".to_owned(),
        false => format!(
            "206 Partial Content\r\nContent-Range: bytes {first}-{}/{}",
            first + body.len() - 1,
            file.len()
        ),
    };
    let head = format!(
        "HTTP/1.1 {status}\r\nContent-Length: {}\r\nConnection: close\r\n\r\n",
        body.len()
    );
    (head, body)
}

pub struct Client(pub SocketAddr);

impl ReadAt for Client {
    fn read_at(&self, offset: u64, buffer: &mut [u8]) -> std::io::Result<usize> {
        let mut stream = TcpStream::connect(self.0)?;
        let last = offset + buffer.len() as u64 - 1;
        write!(
            stream,
            "GET / HTTP/1.1\r\nHost: localhost\r\nRange: bytes={offset}-{last}\r\n\r\n"
        )?;
        let mut reader = BufReader::new(stream);
        let mut length = 0;
        loop {
            let mut line = String::new();
            reader.read_line(&mut line)?;
            if let Some(value) = line.strip_prefix("Content-Length: ") {
                length = value.trim().parse().map_err(std::io::Error::other)?;
            }
            if line.trim().is_empty() {
                break;
            }
        }
        reader.read_exact(&mut buffer[..length])?;
        Ok(length)
    }
}
