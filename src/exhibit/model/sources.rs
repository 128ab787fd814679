//! Bytes that a model refers to: buffers and images in the binary chunk, in data URIs (RFC 2397), or in files beside it.

use std::borrow::Cow;
use std::io::Cursor;
use std::path::Path;

use image::{ColorType, DynamicImage, ImageDecoder, ImageFormat, ImageReader};
use serde_json::Value;

use super::super::budget::Budget;
use super::super::diagnostic::Diagnostic;
use super::super::{files, paths};
use super::fault::{Cause, Fault, Faults};
use super::scene::Image;

/// Most bytes of a model file or of a buffer beside it.
pub const MAX_FILE_BYTES: u64 = 256 << 20;
/// Most pixels of one image.
pub const MAX_IMAGE_PIXELS: u64 = 8192 * 8192;
/// Bytes of a decoded pixel, RGBA.
const PIXEL_BYTES: u64 = 4;
/// Media types of images that are read.
const READ: [&str; 2] = ["image/png", "image/jpeg"];
/// Remedy for images that are too large.
const SHRINK: &str = "gltf-transform resize --width 4096 --height 4096 in.glb out.glb";

/// Where a model's references lead.
pub struct Sources<'a> {
    /// Name of the model's file, for messages.
    pub file: &'a str,
    /// Its folder.
    pub folder: &'a Path,
    /// Its document, checked.
    pub root: &'a Value,
    /// What the exhibit may cost.
    pub budget: &'a Budget,
}

/// What a URI leads to.
struct Read {
    /// Media type of a data URI.
    media: Option<String>,
    /// Size of all of it, bytes.
    size: u64,
    bytes: Vec<u8>,
}

/// The media type of a data URI and its bytes; `None` where it is none that is well formed.
fn data_uri(uri: &str) -> Option<(&str, Vec<u8>)> {
    let (head, data) = uri.strip_prefix("data:")?.split_once(',')?;
    let mut parameters = head.split(';');
    let media = parameters.next()?;
    let mut base64 = false;
    for parameter in parameters {
        match (parameter, parameter.split_once('=')) {
            ("base64", _) => base64 = true,
            (_, Some((name, _))) if !name.is_empty() => {}
            _ => return None,
        }
    }
    let bytes = percent_bytes(data);
    Some((media, if base64 { base64_bytes(&bytes)? } else { bytes }))
}

/// Bytes of a text in which `%41` stands for `A`.
fn percent_bytes(text: &str) -> Vec<u8> {
    let bytes = text.as_bytes();
    let mut out = Vec::with_capacity(bytes.len());
    let mut at = 0;
    while at < bytes.len() {
        let hex = (bytes[at] == b'%').then(|| text.get(at + 1..at + 3)).flatten();
        let escaped = hex.and_then(|hex| u8::from_str_radix(hex, 16).ok());
        out.push(escaped.unwrap_or(bytes[at]));
        at += if escaped.is_some() { 3 } else { 1 };
    }
    out
}

/// Decodes base64 (RFC 4648, both alphabets), with or without padding; `None` where a character is not of it.
fn base64_bytes(text: &[u8]) -> Option<Vec<u8>> {
    let end = text.iter().rposition(|&byte| byte != b'=').map_or(0, |last| last + 1);
    if end % 4 == 1 {
        return None;
    }
    let mut out = Vec::with_capacity(end / 4 * 3 + 2);
    let (mut word, mut bits) = (0_u32, 0);
    for &byte in &text[..end] {
        let six = match byte {
            b'A'..=b'Z' => byte - b'A',
            b'a'..=b'z' => byte - b'a' + 26,
            b'0'..=b'9' => byte - b'0' + 52,
            b'+' | b'-' => 62,
            b'/' | b'_' => 63,
            _ => return None,
        };
        (word, bits) = ((word << 6) | u32::from(six), bits + 6);
        if bits >= 8 {
            bits -= 8;
            out.push((word >> bits) as u8);
            word &= (1 << bits) - 1;
        }
    }
    Some(out)
}

/// Is it an address on a network, such as `https://…`?
fn is_address(uri: &str) -> bool {
    uri.split_once("://").is_some_and(|(scheme, _)| {
        scheme.starts_with(|c: char| c.is_ascii_alphabetic()) && scheme.chars().all(|c| c.is_ascii_alphanumeric())
    })
}

/// The media type of an image's first bytes.
fn media_of(bytes: &[u8]) -> Option<&'static str> {
    match bytes {
        [0x89, b'P', b'N', b'G', ..] => Some("image/png"),
        [0xFF, 0xD8, 0xFF, ..] => Some("image/jpeg"),
        [b'R', b'I', b'F', b'F', _, _, _, _, b'W', b'E', b'B', b'P', ..] => Some("image/webp"),
        _ => None,
    }
}

impl Sources<'_> {
    /// Charges memory for what is at a place.
    fn charge(&self, bytes: u64, place: &str) -> Result<(), Diagnostic> {
        self.budget.charge(bytes).map_err(|excess| Fault::excess(excess, place).diagnostic(self.file))
    }

    /// Bytes of a URI, with its media type if it is a data URI. Of a file, at most the first `most` bytes are read, once
    /// they are charged; the result has the size of the whole file.
    fn read(&self, uri: &str, place: &str, most: u64) -> Result<Read, Diagnostic> {
        if uri.starts_with("data:") {
            // Unescaped and decoded.
            self.charge(2 * uri.len() as u64, place)?;
            return match data_uri(uri) {
                Some((media, bytes)) => {
                    Ok(Read { media: Some(media.to_ascii_lowercase()), size: bytes.len() as u64, bytes })
                }
                None => Err(Fault::at(Cause::Uri, place, "is a data URI that cannot be decoded").diagnostic(self.file)),
            };
        }
        let named = |mut problem: Diagnostic| {
            problem.message = format!("{}: {place}: {}", self.file, problem.message);
            problem
        };
        let path = paths::inside(self.folder, &paths::percent_decoded(uri)).map_err(named)?;
        if uri.is_empty() || uri.contains(':') {
            let what = format_args!("is \"{uri}\", which is no path of a file");
            return Err(Fault::at(Cause::Uri, place, what).diagnostic(self.file));
        }
        let file = files::open_regular(&path).and_then(|file| file.within(MAX_FILE_BYTES)).map_err(named)?;
        let size = file.size();
        self.charge(size.min(most), place)?;
        Ok(Read { media: None, size, bytes: file.read_first(most).map_err(named)? })
    }

    /// Bytes of each buffer; empty where the file does not have them.
    ///
    /// # Errors
    /// A file that cannot be read, or that is shorter than the model says; buffers beyond the budget.
    pub fn buffers(&self, bin: Option<&[u8]>, faults: &mut Faults) -> Result<Vec<Vec<u8>>, Diagnostic> {
        self.announced()?;
        let mut buffers = Vec::new();
        for (index, buffer) in self.root["buffers"].as_array().into_iter().flatten().enumerate() {
            let length = buffer["byteLength"].as_u64().unwrap_or(0) as usize;
            let place = format!("buffers[{index}]");
            let uri = buffer["uri"].as_str();
            let reads = |view: &Value| view["buffer"].as_u64() == Some(index as u64);
            let unread = !self.root["bufferViews"].as_array().into_iter().flatten().any(reads);
            let mut no_data = false;
            let bytes = match uri {
                Some(uri) if is_address(uri) && unread => {
                    let what = format_args!("is \"{uri}\", an address on a network, which is not opened");
                    faults.add(Cause::Skipped, format_args!("{place}.uri"), what);
                    Vec::new()
                }
                Some(uri) => {
                    let Read { media, size, bytes } = self.read(uri, &format!("{place}.uri"), length as u64)?;
                    if size < length as u64 {
                        let from = if media.is_some() { "its data URI" } else { "its file" };
                        return Err(self.short(&place, length, from, size));
                    }
                    let expected = ["application/octet-stream", "application/gltf-buffer"];
                    if let Some(media) = media.filter(|media| !expected.contains(&media.as_str())) {
                        let what = format_args!("is a data URI of \"{media}\"; a buffer's is application/octet-stream");
                        faults.add(Cause::Harmless, format_args!("{place}.uri"), what);
                    }
                    bytes
                }
                None if let Some(bin) = bin.filter(|_| index == 0) => {
                    if bin.len() < length {
                        return Err(self.short(&place, length, "the binary chunk", bin.len() as u64));
                    }
                    self.charge(bin.len() as u64, &place)?;
                    bin.to_vec()
                }
                None => {
                    no_data = true;
                    Vec::new()
                }
            };
            if no_data {
                faults.add(
                    Cause::Skipped,
                    &place,
                    "has no data: it has no uri, and the file no binary chunk for it; what reads it is zeros",
                );
            }
            buffers.push(bytes);
        }
        Ok(buffers)
    }

    /// Do all buffers together fit by their stated lengths? Asked before the first is read.
    fn announced(&self) -> Result<(), Diagnostic> {
        let mut all = 0_u64;
        for (index, buffer) in self.root["buffers"].as_array().into_iter().flatten().enumerate() {
            all = all.saturating_add(buffer["byteLength"].as_u64().filter(|_| buffer["uri"].is_string()).unwrap_or(0));
            let place = format!("buffers[{index}].byteLength");
            self.budget.charge_briefly(all).map_err(|excess| Fault::excess(excess, place).diagnostic(self.file))?;
        }
        Ok(())
    }

    /// A buffer has fewer bytes than it states.
    fn short(&self, place: &str, length: usize, from: &str, has: u64) -> Diagnostic {
        let what = format_args!("is {length}, but {from} has {has} bytes");
        Fault::at(Cause::ShortBuffer, format_args!("{place}.byteLength"), what).diagnostic(self.file)
    }

    /// The decoded images. One that no texture uses may be of another format: then it is a white pixel.
    ///
    /// # Errors
    /// An image that a texture uses cannot be read or decoded, or they are too large.
    pub fn images(&self, buffers: &[Vec<u8>], faults: &mut Faults) -> Result<Vec<Image>, Diagnostic> {
        let list = self.root["images"].as_array().map_or(&[][..], Vec::as_slice);
        let mut used = vec![false; list.len()];
        for source in self.root["textures"].as_array().into_iter().flatten().filter_map(|t| t["source"].as_u64()) {
            used[source as usize] = true;
        }
        let mut images = Vec::new();
        for (index, image) in list.iter().enumerate() {
            let place = format!("images[{index}]");
            match self.image(image, &place, used[index], buffers, faults)? {
                Ok(image) => images.push(image),
                Err(fault) if fault.cause != Cause::Skipped => return Err(fault.diagnostic(self.file)),
                Err(fault) => {
                    faults.add(Cause::Skipped, fault.place, format_args!("{}; no texture uses it", fault.what));
                    images.push(Image { width: 1, height: 1, rgba: vec![u8::MAX; 4] });
                }
            }
        }
        Ok(images)
    }

    fn image(
        &self,
        image: &Value,
        place: &str,
        used: bool,
        buffers: &[Vec<u8>],
        faults: &mut Faults,
    ) -> Result<Result<Image, Fault>, Diagnostic> {
        let stated = image["mimeType"].as_str().map(str::to_owned);
        let (media, bytes) = match image["uri"].as_str() {
            Some(uri) => {
                let Read { media, bytes, .. } = self.read(uri, &format!("{place}.uri"), MAX_FILE_BYTES)?;
                (media, Cow::Owned(bytes))
            }
            None => (None, Cow::Borrowed(view(self.root, image, buffers))),
        };
        // Where nothing says that it should be readable, it may be of a format for other programs.
        let readable = [&stated, &media].into_iter().flatten().any(|kind| READ.contains(&kind.as_str()));
        let cause = if readable || used { Cause::Image } else { Cause::Skipped };
        let refused = |what: String| Ok(Err(Fault::at(cause, place, what)));
        if bytes.is_empty() {
            return refused("has no data".to_owned());
        }
        let found = media_of(&bytes);
        for stated in [media, stated].into_iter().flatten() {
            if found.is_some_and(|found| found != stated) {
                let what = format_args!("is stated to be {stated}, and is {}", found.unwrap_or_default());
                faults.add(Cause::Harmless, place, what);
            }
        }
        // The header comes first: a small file can claim an image that fills the memory.
        let reader = ImageReader::new(Cursor::new(&bytes)).with_guessed_format();
        let reader = reader.map_err(image::ImageError::from);
        let format = reader.as_ref().ok().and_then(ImageReader::format);
        let decoder = match reader.and_then(ImageReader::into_decoder) {
            Ok(decoder) => decoder,
            Err(error) => return refused(format!("cannot be decoded: {error}")),
        };
        let (width, height) = decoder.dimensions();
        if width == 0 || height == 0 {
            return refused(format!("is {width} × {height} pixels"));
        }
        let size = u64::from(width) * u64::from(height);
        if size > MAX_IMAGE_PIXELS {
            let what = format_args!("is {width} × {height}; the limit is 8192 × 8192");
            return Ok(Err(Fault::at(Cause::Limit, place, what).remedy(SHRINK)));
        }
        let while_decoding = bytes.len() as u64 + decoding_bytes(&decoder, format);
        let charged = self.budget.charge_briefly(while_decoding).and_then(|()| self.budget.charge(PIXEL_BYTES * size));
        if let Err(excess) = charged {
            let what = format_args!("is {width} × {height} pixels: {excess}");
            return Ok(Err(Fault::at(Cause::Budget, place, what).remedy(excess.help())));
        }
        match DynamicImage::from_decoder(decoder) {
            Ok(decoded) => Ok(Ok(Image { width, height, rgba: decoded.into_rgba8().into_raw() })),
            Err(error) => refused(format!("cannot be decoded: {error}")),
        }
    }
}

/// Most memory while an image is decoded and converted to RGBA, bytes.
fn decoding_bytes(decoder: &impl ImageDecoder, format: Option<ImageFormat>) -> u64 {
    let decoded = decoder.total_bytes();
    // A progressive JPEG keeps its coefficients, 16 bits each.
    let coefficients = if format == Some(ImageFormat::Jpeg) { 2 * decoded } else { 0 };
    let (width, height) = decoder.dimensions();
    let converted = match decoder.color_type() {
        ColorType::Rgba8 => 0,
        _ => PIXEL_BYTES * u64::from(width) * u64::from(height),
    };
    decoded + coefficients.max(converted)
}

/// Bytes of an image's buffer view; empty where its buffer has none.
fn view<'b>(root: &Value, image: &Value, buffers: &'b [Vec<u8>]) -> &'b [u8] {
    let number = |value: &Value, key: &str| value[key].as_u64().unwrap_or(0) as usize;
    let view = &root["bufferViews"][number(image, "bufferView")];
    let start = number(view, "byteOffset");
    let end = start.saturating_add(number(view, "byteLength"));
    buffers.get(number(view, "buffer")).and_then(|buffer| buffer.get(start..end)).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn data_uris_are_decoded_or_refused() {
        let media = "application/octet-stream";
        let uri = |tail: &str| data_uri(&format!("data:{media}{tail}")).map(|(_, bytes)| bytes);
        // RFC 4648, section 10.
        for (text, bytes) in [("Zg==", "f"), ("Zm8=", "fo"), ("Zm9v", "foo"), ("Zm9vYg", "foob"), ("", "")] {
            assert_eq!(uri(&format!(";base64,{text}")).as_deref(), Some(bytes.as_bytes()), "{text}");
        }
        assert_eq!(uri(";base64,-_8").as_deref(), Some(&[0xFB, 0xFF][..]), "the alphabet of URLs");
        assert_eq!(uri(",a%00b").as_deref(), Some(&b"a\0b"[..]), "without base64");
        for wrong in [";base64,`", ";base64,A", ";;base64,AA==", ""] {
            assert_eq!(uri(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn addresses_are_told_from_paths() {
        assert!(is_address("https://example.org/a.bin") && is_address("ftp://a"));
        assert!(!is_address("a.bin") && !is_address("a/b://c") && !is_address("://a"));
    }
}
