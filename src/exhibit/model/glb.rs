//! The container of a model: a GLB (glTF 2.0, chapter 4) or plain JSON.
//!
//! A GLB is a header (magic, version, length) and chunks (length, type, bytes): JSON first, then at most one BIN. Bytes
//! after the stated length, and chunks of other types after these two, are ignored, as the standard asks.

use super::fault::{Cause, Fault, Faults};

const MAGIC: &[u8] = b"glTF";
const JSON: u32 = 0x4E4F_534A;
const BIN: u32 = 0x004E_4942;
/// Bytes of the header, and of that of a chunk.
const HEADER: usize = 12;
const CHUNK_HEADER: usize = 8;
/// The byte-order mark of UTF-8.
const BOM: &[u8] = &[0xEF, 0xBB, 0xBF];

/// The parts of a model's file.
pub struct Parts<'a> {
    /// JSON text.
    pub json: &'a [u8],
    /// The binary chunk.
    pub bin: Option<&'a [u8]>,
}

/// Splits a file.
///
/// # Errors
/// It is neither JSON nor a whole GLB.
pub fn split<'a>(bytes: &'a [u8], faults: &mut Faults) -> Result<Parts<'a>, Fault> {
    let mut parts = if bytes.starts_with(MAGIC) {
        chunks(bytes, faults)?
    } else if bytes.is_empty() {
        return Err(Fault::new(Cause::Truncated, "the file is empty"));
    } else if MAGIC.starts_with(bytes) {
        return Err(Fault::new(Cause::Truncated, "the file ends within the header of a GLB"));
    } else {
        let text = bytes.strip_prefix(BOM).unwrap_or(bytes);
        if text.first().is_none_or(|&byte| !matches!(byte, b'{' | b'[' | b' ' | b'\t' | b'\r' | b'\n' | b'"')) {
            return Err(Fault::new(Cause::NotGltf, "begins neither as a GLB nor as JSON"));
        }
        Parts { json: bytes, bin: None }
    };
    if let Some(text) = parts.json.strip_prefix(BOM) {
        faults.add(Cause::Harmless, "", "its JSON begins with a byte-order mark");
        parts.json = text;
    }
    Ok(parts)
}

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    bytes.get(at..at + 4).and_then(|word| word.try_into().ok()).map(u32::from_le_bytes)
}

fn chunks<'a>(bytes: &'a [u8], faults: &mut Faults) -> Result<Parts<'a>, Fault> {
    let (Some(version), Some(length)) = (word(bytes, 4), word(bytes, 8)) else {
        return Err(Fault::new(Cause::Truncated, "the file ends within the header of a GLB"));
    };
    if version != 2 {
        return Err(Fault::new(Cause::Version, format_args!("a GLB of version {version}; version 2 is read")));
    }
    let length = length as usize;
    if length < HEADER {
        return Err(Fault::new(Cause::Container, "not a complete GLB: its length is shorter than its header"));
    }
    let Some(body) = bytes.get(..length) else {
        let has = bytes.len();
        return Err(Fault::new(Cause::Truncated, format_args!("has {has} bytes of the {length} that its header says")));
    };
    if length == HEADER {
        return Err(Fault::new(Cause::Container, "a GLB without chunks: it has a header alone"));
    }
    if length < bytes.len() {
        let extra = bytes.len() - length;
        faults.add(Cause::Harmless, "", format_args!("{extra} bytes follow the end of the GLB; they are ignored"));
    }
    let (mut json, mut bin, mut at, mut index) = (None, None, HEADER, 0);
    while at < body.len() {
        let (Some(size), Some(kind)) = (word(body, at), word(body, at + 4)) else {
            return Err(Fault::new(
                Cause::Container,
                format_args!("its length ends within the header of chunk {index}"),
            ));
        };
        let (start, size) = (at + CHUNK_HEADER, size as usize);
        let chunk = start.checked_add(size).and_then(|end| body.get(start..end)).ok_or_else(|| {
            let left = body.len() - start;
            Fault::new(
                Cause::Container,
                format_args!("chunk {index} has {size} bytes by its header, {left} in the GLB"),
            )
        })?;
        if size % 4 != 0 {
            faults.add(Cause::Harmless, "", format_args!("chunk {index} has {size} bytes, not a multiple of 4"));
        }
        match (index, kind) {
            (0, JSON) if chunk.is_empty() => return Err(Fault::new(Cause::Container, "its JSON chunk is empty")),
            (0, JSON) => json = Some(chunk),
            (0, _) => {
                return Err(Fault::new(Cause::Container, format_args!("chunk 0 is of type {kind:#010x}, not JSON")));
            }
            (1, BIN) => bin = Some(chunk),
            (_, JSON) => {
                return Err(Fault::new(Cause::Container, format_args!("chunk {index} is a second JSON chunk")));
            }
            (_, BIN) if bin.is_some() => {
                return Err(Fault::new(Cause::Container, format_args!("chunk {index} is a second BIN chunk")));
            }
            (_, BIN) => {
                return Err(Fault::new(Cause::Container, format_args!("BIN is chunk {index}; it must be chunk 1")));
            }
            _ => {}
        }
        (at, index) = (start + size, index + 1);
    }
    let json = json.ok_or_else(|| Fault::new(Cause::Container, "has no JSON chunk"))?;
    Ok(Parts { json, bin })
}
