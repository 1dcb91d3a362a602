//! The client of the tool `stream` before servers that lie, stall and break off: an error each, nothing else.

mod common;
#[path = "../tools/src/http_file.rs"]
mod http_file;

use std::io::{self, ErrorKind, Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use common::server::{Request, Server, answer, send};
use http_file::HttpFile;
use welkin::{Conditions, Error, Model, ReadAt};

/// For answers that come.
const PATIENT: Duration = Duration::from_secs(60);
/// For answers that do not.
const BRIEF: Duration = Duration::from_millis(700);
/// More than the first request of a model asks for.
const LENGTH: usize = 100_000;

fn file() -> Vec<u8> {
    (0..LENGTH).map(|i| (i * 7 % 251) as u8).collect()
}

fn read(file: &HttpFile, offset: u64, length: usize) -> io::Result<Vec<u8>> {
    let mut buffer = vec![0; length];
    let n = file.read_at(offset, &mut buffer)?;
    buffer.truncate(n);
    Ok(buffer)
}

/// What a read of 1000 bytes at 500 says where the honest head and body are changed by `lie`.
fn told(
    lie: impl Fn(String, Vec<u8>) -> (String, Vec<u8>) + Send + 'static,
) -> io::Result<Vec<u8>> {
    let bytes = file();
    let server = Server::with(move |request, stream| {
        let (head, body) = answer(&request, &bytes, "\"1\"");
        let (head, body) = lie(head, body);
        send(stream, &head, &body);
    });
    read(&HttpFile::new(server.url(), PATIENT), 500, 1000)
}

#[track_caller]
fn refused<T>(outcome: io::Result<T>, kind: ErrorKind, what: &str) {
    let error = outcome.err().expect("an error");
    assert!(error.to_string().contains(what), "{what}: {error}");
    assert_eq!(error.kind(), kind, "{error}");
}

#[test]
fn an_honest_server_gives_every_part_and_the_end() {
    let bytes = file();
    let server = Server::start(bytes.clone());
    let file = HttpFile::new(server.url(), PATIENT);
    assert_eq!(read(&file, 500, 1000).unwrap(), bytes[500..1500]);
    assert_eq!(read(&file, 0, LENGTH).unwrap(), bytes);
    assert_eq!(read(&file, 99_990, 1000).unwrap(), bytes[99_990..]);
    let requests = server.requests.load(Ordering::Relaxed);
    assert_eq!(read(&file, 99_990, 0).unwrap(), []);
    assert_eq!(read(&file, LENGTH as u64, 10).unwrap(), []);
    assert_eq!(read(&file, u64::MAX, 10).unwrap(), []);
    assert_eq!(server.requests.load(Ordering::Relaxed), requests);
    // Before anything is known about the file.
    let file = HttpFile::new(server.url(), PATIENT);
    assert_eq!(read(&file, LENGTH as u64, 10).unwrap(), []);
    assert_eq!(read(&file, 99_990, 1000).unwrap(), bytes[99_990..]);
}

#[test]
fn harmless_differences_are_no_lies() {
    let part = file()[500..1500].to_vec();
    let without = |head: String, name: &str| {
        let lines = head.split_inclusive("\r\n");
        lines.filter(|l| !l.starts_with(name)).collect::<String>()
    };
    // Without a length the body ends with the connection.
    assert_eq!(
        told(move |h, b| (without(h, "Content-Length"), b)).unwrap(),
        part
    );
    let chunked = move |h: String, b: Vec<u8>| {
        let head = without(h, "Content-Length") + "Transfer-Encoding: chunked\r\n";
        (head, [b"3e8\r\n", &b[..], b"\r\n0\r\n\r\n"].concat())
    };
    assert_eq!(told(chunked).unwrap(), part);
    let dated = |h: String, b| {
        (
            h.replace(
                "ETag: \"1\"",
                "Last-Modified: Sat, 29 Nov 2025 10:00:00 GMT",
            ),
            b,
        )
    };
    assert_eq!(told(dated).unwrap(), part);
    assert_eq!(
        told(|h, b| (h + "Content-Encoding: identity\r\n", b)).unwrap(),
        part
    );
}

#[test]
fn the_whole_file_instead_of_a_part() {
    let whole = |_, _| {
        (
            format!("HTTP/1.1 200 OK\r\nContent-Length: {LENGTH}\r\n"),
            file(),
        )
    };
    refused(told(whole), ErrorKind::InvalidData, "knows no ranges");
}

#[test]
fn statuses_that_are_no_answer() {
    for status in [
        "204 No Content",
        "304 Not Modified",
        "404 Not Found",
        "500 Oops",
        "299 Odd",
    ] {
        let lie = move |h: String, b| (h.replace("206 Partial Content", status), b);
        refused(told(lie), ErrorKind::Other, &status[..3]);
    }
}

#[test]
fn content_ranges_that_are_not_what_was_asked_for() {
    for (range, what) in [
        ("", "without Content-Range"),
        ("Content-Range: bytes 0-999/100000\r\n", "got 0-999"),
        ("Content-Range: bytes 500-1498/100000\r\n", "got 500-1498"),
        ("Content-Range: bytes 500-1500/100000\r\n", "got 500-1500"),
        ("Content-Range: bytes 500-1499/1200\r\n", "no part"),
        ("Content-Range: bytes 500-1499/*\r\n", "no part"),
        ("Content-Range: bytes 1499-500/100000\r\n", "no part"),
        (
            "Content-Range: bytes 500-18446744073709551616/100000\r\n",
            "no part",
        ),
        (
            "Content-Range: bytes 500-18446744073709551615/18446744073709551615\r\n",
            "no part",
        ),
        (
            "Content-Range: bytes 0-18446744073709551614/18446744073709551615\r\n",
            "got 0-",
        ),
        ("Content-Range: lines 500-1499/100000\r\n", "no part"),
        ("Content-Range: bytes -500-1499/100000\r\n", "no part"),
        ("Content-Range: \u{fe}\r\n", "no text"),
        (
            "Content-Range: bytes 500-1499/100000\r\nContent-Range: bytes 0-999/100000\r\n",
            "twice",
        ),
    ] {
        let honest = "Content-Range: bytes 500-1499/100000\r\n";
        let lie = move |h: String, b| (h.replace(honest, range), b);
        refused(told(lie), ErrorKind::InvalidData, what);
    }
}

#[test]
fn lengths_that_are_not_those_of_the_range() {
    for length in ["999", "1001", "1000000000000000000"] {
        let lie = move |h: String, b| (h.replace("Length: 1000", &format!("Length: {length}")), b);
        refused(told(lie), ErrorKind::InvalidData, "1000 bytes announced as");
    }
    for length in ["-1", "many", "99999999999999999999999"] {
        let lie = move |h: String, b| (h.replace("Length: 1000", &format!("Length: {length}")), b);
        assert!(told(lie).is_err(), "{length}");
    }
}

#[test]
fn bodies_that_break_off() {
    for kept in [0, 1, 999] {
        let lie = move |h, mut b: Vec<u8>| {
            b.truncate(kept);
            (h, b)
        };
        refused(told(lie), ErrorKind::UnexpectedEof, "");
    }
}

#[test]
fn bodies_that_do_not_end() {
    let endless = |h: String, b: Vec<u8>| {
        let head = h.replace("Content-Length: 1000\r\n", "Transfer-Encoding: chunked\r\n");
        (
            head,
            [b"3e8\r\n", &b[..], b"\r\n", &b"1\r\nx\r\n".repeat(1000)].concat(),
        )
    };
    refused(
        told(endless),
        ErrorKind::InvalidData,
        "longer than was said",
    );
    let unframed =
        |h: String, b: Vec<u8>| (h.replace("Content-Length: 1000\r\n", ""), b.repeat(100));
    refused(
        told(unframed),
        ErrorKind::InvalidData,
        "longer than was said",
    );
}

#[test]
fn bodies_that_are_encoded() {
    let lie = |h, b| (h + "Content-Encoding: gzip\r\n", b);
    refused(told(lie), ErrorKind::InvalidData, "encoded as gzip");
}

#[test]
fn files_whose_version_is_not_named() {
    for tag in ["", "ETag: W/\"1\"\r\n"] {
        let lie = move |h: String, b| (h.replace("ETag: \"1\"\r\n", tag), b);
        refused(told(lie), ErrorKind::InvalidData, "neither a strong ETag");
    }
}

/// Reads twice from a server that has another file after the first request.
fn changed(later: impl Fn(&Request) -> (String, Vec<u8>) + Send + 'static) -> io::Result<Vec<u8>> {
    let bytes = file();
    let server = Server::with(move |request, stream| {
        let (head, body) = match request.number {
            0 => answer(&request, &bytes, "\"1\""),
            _ => later(&request),
        };
        send(stream, &head, &body);
    });
    let file = HttpFile::new(server.url(), PATIENT);
    read(&file, 0, 1000).unwrap();
    read(&file, 5000, 1000)
}

#[test]
fn files_that_change_between_requests() {
    let what = "the file has changed";
    let other = || vec![1; LENGTH];
    // An honest server sees from If-Range that the question is about a file that is gone.
    let honest = changed(move |r| {
        assert_eq!(r.if_range.as_deref(), Some("\"1\""));
        answer(r, &other(), "\"2\"")
    });
    refused(honest, ErrorKind::InvalidData, what);
    let deaf = |r: &Request| Request {
        if_range: None,
        path: r.path.clone(),
        ..*r
    };
    let another_tag = changed(move |r| answer(&deaf(r), &other(), "\"2\""));
    refused(another_tag, ErrorKind::InvalidData, what);
    let another_length = changed(move |r| answer(&deaf(r), &[1; LENGTH + 1], "\"1\""));
    refused(another_length, ErrorKind::InvalidData, what);
    let shorter = changed(move |r| answer(&deaf(r), &[1; 2000], "\"1\""));
    refused(shorter, ErrorKind::InvalidData, "byte 5000 is refused");
}

#[test]
fn ends_that_are_none() {
    for range in ["bytes */100000", "bytes */", "bytes 0-1/2", "nothing"] {
        let head = format!("HTTP/1.1 416 No\r\nContent-Length: 0\r\nContent-Range: {range}\r\n");
        refused(
            told(move |_, _| (head.clone(), vec![])),
            ErrorKind::InvalidData,
            "byte 500 is refused",
        );
    }
}

#[test]
fn redirects_are_followed_to_an_end() {
    let bytes = file();
    let expected = bytes[500..1500].to_vec();
    let server = Server::with(move |request, stream| match request.path.as_str() {
        "/model.welkin" => send(
            stream,
            "HTTP/1.1 302 Found\r\nLocation: /there\r\nContent-Length: 0\r\n",
            b"",
        ),
        _ => {
            let (head, body) = answer(&request, &bytes, "\"1\"");
            send(stream, &head, &body);
        }
    });
    let file = HttpFile::new(server.url(), PATIENT);
    assert_eq!(read(&file, 500, 1000).unwrap(), expected);
}

#[test]
fn redirects_that_lead_nowhere() {
    for location in [
        "/model.welkin",
        "https://127.0.0.1:1/",
        "ftp://x/",
        "http://",
        "::",
        "\u{fe}",
    ] {
        let head = format!("HTTP/1.1 302 Found\r\nLocation: {location}\r\nContent-Length: 0\r\n");
        let server = Server::with(move |_, stream| send(stream, &head, b""));
        let outcome = read(&HttpFile::new(server.url(), PATIENT), 500, 1000);
        assert!(outcome.is_err(), "{location}");
        assert!(server.requests.load(Ordering::Relaxed) <= 5);
    }
    let lost = told(|_, _| ("HTTP/1.1 302 Found\r\nContent-Length: 0\r\n".into(), vec![]));
    assert!(lost.is_err());
}

#[test]
fn heads_that_are_none_or_do_not_end() {
    let head = "HTTP/1.1 206 Partial Content\r\n";
    for text in [
        "".to_owned(),
        "\r\n\r\n".to_owned(),
        "SSH-2.0-OpenSSH_9.2\r\n".to_owned(),
        "HTTP/1.1 206".to_owned(),
        head.to_owned(),
        format!("{head}no colon\r\n\r\n"),
        format!("{head}{}", "X: y\r\n".repeat(100_000)),
        format!("{head}X: {}", "y".repeat(1_000_000)),
    ] {
        let shown = text.chars().take(50).collect::<String>();
        let server = Server::with(move |_, stream| {
            let _ = stream.write_all(text.as_bytes());
        });
        let outcome = read(&HttpFile::new(server.url(), PATIENT), 500, 1000);
        assert!(outcome.is_err(), "{shown}");
    }
}

/// Repeats `what` as long as the other side is there, but no longer than ten seconds.
fn drip(stream: &mut TcpStream, what: &str) {
    let start = Instant::now();
    let _ = stream.set_read_timeout(Some(Duration::from_millis(20)));
    while start.elapsed() < Duration::from_secs(10) && stream.write_all(what.as_bytes()).is_ok() {
        if let Ok(0) = stream.read(&mut [0]) {
            break;
        }
    }
}

#[test]
fn servers_that_are_silent_or_drip() {
    let head =
        "HTTP/1.1 206 Partial Content\r\nETag: \"1\"\r\nContent-Range: bytes 500-1499/100000\r\n";
    for (start, drops) in [
        (String::new(), ""),
        (String::new(), "HTTP/1.1 100 Continue\r\n\r\n"),
        (head.to_owned(), ""),
        (head.to_owned(), "X: y\r\n"),
        (format!("{head}Content-Length: 1000\r\n\r\n"), ""),
        (format!("{head}Content-Length: 1000\r\n\r\n"), "x"),
    ] {
        let shown = format!("{start:?}, then {drops:?}");
        let server = Server::with(move |_, stream| {
            let _ = stream.write_all(start.as_bytes());
            drip(stream, drops);
        });
        let began = Instant::now();
        let outcome = read(&HttpFile::new(server.url(), BRIEF), 500, 1000);
        assert!(began.elapsed() < Duration::from_secs(8), "{shown}");
        let error = outcome.expect_err(&shown);
        assert_eq!(error.kind(), ErrorKind::TimedOut, "{shown}: {error}");
    }
}

#[test]
fn connections_that_are_refused_or_broken() {
    let free = TcpListener::bind("127.0.0.1:0")
        .unwrap()
        .local_addr()
        .unwrap();
    let nobody = HttpFile::new(format!("http://{free}/"), PATIENT);
    assert!(read(&nobody, 0, 10).is_err());
    let server = Server::with(|_, stream| stream.shutdown(Shutdown::Both).unwrap_or(()));
    assert!(read(&HttpFile::new(server.url(), PATIENT), 0, 10).is_err());
    for url in [
        "",
        "model.welkin",
        "http://",
        "https://127.0.0.1/",
        "http://127.0.0.1:99999/",
    ] {
        assert!(read(&HttpFile::new(url, PATIENT), 0, 10).is_err(), "{url}");
    }
}

/// A model says which read failed, and can go on when the server is honest again.
#[test]
fn a_model_over_a_lying_server_is_a_typed_error() {
    let bytes = common::model_bytes();
    let whole = bytes.clone();
    let server = Server::with(move |_, stream| {
        send(
            stream,
            &format!("HTTP/1.1 200 OK\r\nContent-Length: {}\r\n", whole.len()),
            &whole,
        );
    });
    let outcome = Model::stream(HttpFile::new(server.url(), PATIENT));
    assert!(matches!(outcome, Err(Error::Read { offset: 0, .. })));
    // Honest at first, another file for one request, and honest again.
    let altitudes: Vec<f64> = (0..24).map(|i| 100.0 * f64::from(i)).collect();
    let head = common::head_with(&altitudes, &[20e3, 40e3, 60e3, 80e3, 130e3], 20);
    let bytes = welkin::format::encode(&head, &common::chunks(&head)).unwrap();
    assert!(bytes.len() > 48 << 10, "one request is not all of it");
    let version = Arc::new(AtomicU64::new(1));
    let there = version.clone();
    let server = Server::with(move |request, stream| {
        let tag = format!("\"{}\"", there.load(Ordering::Relaxed));
        let (head, body) = answer(&request, &bytes, &tag);
        send(stream, &head, &body);
    });
    let model = Model::stream(HttpFile::new(server.url(), PATIENT)).unwrap();
    let conditions = Conditions {
        altitude: 2250.0,
        visibility: 100e3,
        ..Conditions::default()
    };
    version.store(2, Ordering::Relaxed);
    match model.sky(&conditions) {
        Err(Error::Read { source, .. }) => {
            refused(Err::<(), _>(source), ErrorKind::InvalidData, "changed")
        }
        Err(other) => panic!("{other}"),
        Ok(_) => panic!("the head of one file with the chunks of another"),
    }
    version.store(1, Ordering::Relaxed);
    assert!(model.sky(&conditions).is_ok());
}
