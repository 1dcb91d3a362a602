//! The header of an EXR file, so that the same picture is the same file.

/// Sorts the attributes of a file with one part by name: the encoder writes those that it does not know in an order of
/// their own every time. What is no such header is left as it is.
pub fn sort(file: &mut [u8]) {
    /// Magic number and version.
    const START: usize = 8;
    let mut attributes = Vec::new();
    let mut at = START;
    while file.get(at).is_some_and(|&byte| byte != 0) {
        let Some(length) = length(&file[at..]) else {
            return;
        };
        attributes.push(file[at..at + length].to_vec());
        at += length;
    }
    attributes.sort();
    file[START..at].copy_from_slice(&attributes.concat());
}

/// Bytes of an attribute: its name and type, each with a zero at its end, the length of its value, and that.
fn length(bytes: &[u8]) -> Option<usize> {
    let word = |from: usize| bytes[from..].iter().position(|&byte| byte == 0);
    let name = word(0)? + 1;
    let kind = name + word(name)? + 1;
    let size = bytes.get(kind..kind + 4)?.try_into().ok()?;
    let length = kind + 4 + usize::try_from(u32::from_le_bytes(size)).ok()?;
    (length <= bytes.len()).then_some(length)
}
