//! A file behind a web server that answers range requests, as [`welkin::Model::stream`] reads it. Nothing that the
//! server says is believed before it is checked.

use std::io::{self, Read};
use std::sync::OnceLock;
use std::time::Duration;

use ureq::Agent;
use ureq::http::{HeaderMap, Response, StatusCode, header};
use welkin::ReadAt;

/// One file at a URL, of which all parts are of the version that the first answer was of.
pub struct HttpFile {
    agent: Agent,
    url: String,
    version: OnceLock<Version>,
}

/// What tells one version of a file from another.
#[derive(Clone, PartialEq)]
struct Version {
    /// A strong ETag or a date: what `If-Range` takes.
    validator: String,
    length: u64,
}

impl HttpFile {
    /// The file at `url` (`http://…`; `https` needs a TLS feature of ureq). Asks nothing yet. No read, redirects
    /// included, takes longer than `timeout`.
    pub fn new(url: impl Into<String>, timeout: Duration) -> Self {
        let config = Agent::config_builder()
            // The loopback has none; without this line ureq takes the one of the environment.
            .proxy(None)
            .timeout_global(Some(timeout))
            .http_status_as_error(false)
            .max_redirects(4)
            .max_response_header_size(16 << 10)
            .accept_encoding("identity");
        Self {
            agent: config.build().new_agent(),
            url: url.into(),
            version: OnceLock::new(),
        }
    }

    fn ask(&self, first: u64, last: u64) -> io::Result<Response<ureq::Body>> {
        let mut request = self.agent.get(&self.url);
        request = request.header(header::RANGE, format!("bytes={first}-{last}"));
        if let Some(version) = self.version.get() {
            request = request.header(header::IF_RANGE, &version.validator);
        }
        request.call().map_err(failure)
    }

    /// Takes the answer's version for the file's if it is the first, and refuses any other.
    fn check_version(&self, headers: &HeaderMap, length: u64) -> io::Result<()> {
        let version = Version {
            validator: validator(headers)?,
            length,
        };
        match self.version.get_or_init(|| version.clone()) == &version {
            true => Ok(()),
            false => Err(lie("the file has changed since its first part was read")),
        }
    }

    /// Where the answer to a request for bytes from `first` to `last` ends, checked against all that its head says.
    fn check_head(
        &self,
        response: &Response<ureq::Body>,
        first: u64,
        last: u64,
    ) -> io::Result<u64> {
        let headers = response.headers();
        let range = content_range(headers)?;
        self.check_version(headers, range.length)?;
        // A server may send less than was asked for, but then the reader would take it for the end of the file.
        if range.first != first || range.last != last.min(range.length - 1) {
            return Err(lie(format!(
                "asked for bytes {first}-{last}, got {}-{} of {}",
                range.first, range.last, range.length
            )));
        }
        if let Some(encoding) = only(headers, header::CONTENT_ENCODING)?
            && encoding != "identity"
        {
            return Err(lie(format!("the part is encoded as {encoding}")));
        }
        let size = range.last - first + 1;
        if let Some(told) = only(headers, header::CONTENT_LENGTH)?
            && told.parse() != Ok(size)
        {
            return Err(lie(format!("{size} bytes announced as {told}")));
        }
        Ok(range.last)
    }

    /// A request beyond the end.
    fn check_unsatisfiable(&self, headers: &HeaderMap, first: u64) -> io::Result<()> {
        let range = only(headers, header::CONTENT_RANGE)?.unwrap_or_default();
        let length: Option<u64> = range.strip_prefix("bytes */").and_then(|n| n.parse().ok());
        let known = self.version.get().map(|v| v.length);
        match length {
            Some(length) if length <= first && known.is_none_or(|known| known == length) => Ok(()),
            _ => Err(lie(format!(
                "byte {first} is refused with Content-Range \"{range}\""
            ))),
        }
    }
}

impl ReadAt for HttpFile {
    fn read_at(&self, offset: u64, buffer: &mut [u8]) -> io::Result<usize> {
        let end = self.version.get().map_or(u64::MAX, |v| v.length);
        if buffer.is_empty() || offset >= end {
            return Ok(0);
        }
        let last = offset.saturating_add(buffer.len() as u64 - 1).min(end - 1);
        let response = self.ask(offset, last)?;
        match response.status() {
            StatusCode::PARTIAL_CONTENT => {
                let last = self.check_head(&response, offset, last)?;
                let size = (last - offset + 1) as usize;
                read_body(response, &mut buffer[..size])?;
                Ok(size)
            }
            StatusCode::RANGE_NOT_SATISFIABLE => {
                self.check_unsatisfiable(response.headers(), offset)?;
                Ok(0)
            }
            StatusCode::OK if self.version.get().is_some() => {
                Err(lie("the file has changed since its first part was read"))
            }
            StatusCode::OK => Err(lie("the server sends the whole file, it knows no ranges")),
            status => Err(io::Error::other(format!("the server answers {status}"))),
        }
    }
}

/// Fills `buffer` with the body, which must end there.
fn read_body(response: Response<ureq::Body>, buffer: &mut [u8]) -> io::Result<()> {
    let mut body = response.into_body().into_reader();
    body.read_exact(buffer).map_err(|e| failure(e.into()))?;
    match body.read(&mut [0]).map_err(|e| failure(e.into()))? {
        0 => Ok(()),
        _ => Err(lie("the part is longer than was said")),
    }
}

struct ContentRange {
    first: u64,
    last: u64,
    length: u64,
}

/// `bytes FIRST-LAST/LENGTH`, with `FIRST ≤ LAST < LENGTH`.
fn content_range(headers: &HeaderMap) -> io::Result<ContentRange> {
    let text = only(headers, header::CONTENT_RANGE)?
        .ok_or_else(|| lie("part of a file without Content-Range"))?;
    let parts = text.strip_prefix("bytes ").and_then(|rest| {
        let (range, length) = rest.split_once('/')?;
        let (first, last) = range.split_once('-')?;
        Some([first, last, length].map(|n| n.parse::<u64>().ok()))
    });
    match parts {
        Some([Some(first), Some(last), Some(length)]) if first <= last && last < length => {
            Ok(ContentRange {
                first,
                last,
                length,
            })
        }
        _ => Err(lie(format!(
            "Content-Range \"{text}\" is no part of a file"
        ))),
    }
}

/// The strong ETag, or else the date of the last change.
fn validator(headers: &HeaderMap) -> io::Result<String> {
    let strong = only(headers, header::ETAG)?.filter(|tag| !tag.starts_with("W/"));
    let validator = match strong {
        Some(tag) => Some(tag),
        None => only(headers, header::LAST_MODIFIED)?,
    };
    let validator = validator.ok_or_else(|| {
        lie("neither a strong ETag nor Last-Modified: a change between two parts would not be seen")
    })?;
    Ok(validator.to_owned())
}

/// The header, if it is there: once, and readable.
fn only(headers: &HeaderMap, name: header::HeaderName) -> io::Result<Option<&str>> {
    let mut values = headers.get_all(&name).iter();
    let value = values.next();
    if values.next().is_some() {
        return Err(lie(format!("{name} is there twice")));
    }
    let text = value.map(|v| v.to_str());
    text.transpose()
        .map_err(|_| lie(format!("{name} is no text")))
}

fn lie(what: impl Into<String>) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, what.into())
}

/// Keeps the kind where there is one for it.
fn failure(error: ureq::Error) -> io::Error {
    match error {
        ureq::Error::Timeout(_) => io::Error::new(io::ErrorKind::TimedOut, error),
        error => error.into_io(),
    }
}
