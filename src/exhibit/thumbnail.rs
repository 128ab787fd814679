//! The thumbnail of an exhibit: `thumbnail.png` in its folder, for the page of exhibits.

use std::io::Cursor;
use std::path::Path;

use image::{DynamicImage, ImageDecoder, ImageReader, RgbaImage};

use super::budget::{Budget, Excess};
use super::diagnostic::Diagnostic;
use super::{codes, files};

/// File name, in the exhibit's folder.
pub const THUMBNAIL: &str = "thumbnail.png";
/// Most pixels along a side: a picture of a 4K screen (3840 × 2160) fits.
pub const MAX_SIDE: u32 = 4096;
/// Most bytes of the file. A PNG of noise of 4K has 33 MB.
const MAX_BYTES: u64 = 64 << 20;

/// Checks the header of a folder's thumbnail against the limits, without decoding it. A missing thumbnail is good.
///
/// # Errors
/// It is no regular file of the folder, or too large.
pub(super) fn check(folder: &Path, budget: &Budget) -> Result<(), Diagnostic> {
    if folder.join(THUMBNAIL).symlink_metadata().is_err() {
        return Ok(());
    }
    let bytes = bytes(folder, budget)?;
    decoder(&bytes, folder, budget).map(drop)
}

/// The folder's thumbnail, scaled to fill `width` × `height`; `None` where it is missing, beyond the limits, or cannot be decoded.
pub fn read(folder: &Path, [width, height]: [u32; 2]) -> Option<RgbaImage> {
    let budget = Budget::default();
    let bytes = bytes(folder, &budget).ok()?;
    let picture = DynamicImage::from_decoder(decoder(&bytes, folder, &budget).ok()??).ok()?;
    Some(picture.resize_to_fill(width, height, image::imageops::FilterType::Triangle).to_rgba8())
}

/// The bytes of the file.
fn bytes(folder: &Path, budget: &Budget) -> Result<Vec<u8>, Diagnostic> {
    let file = files::open_inside(folder, THUMBNAIL)?.within(MAX_BYTES)?;
    budget.charge_briefly(file.size()).map_err(|excess| refused(folder, excess))?;
    file.read()
}

/// The decoder of a thumbnail within the limits; `None` where the bytes are no image.
fn decoder<'b>(
    bytes: &'b [u8],
    folder: &Path,
    budget: &Budget,
) -> Result<Option<impl ImageDecoder + use<'b>>, Diagnostic> {
    let decoder = ImageReader::new(Cursor::new(bytes)).with_guessed_format().ok().map(ImageReader::into_decoder);
    let Some(Ok(decoder)) = decoder else { return Ok(None) };
    let (width, height) = decoder.dimensions();
    if width.max(height) > MAX_SIDE {
        let shown = folder.join(THUMBNAIL);
        let message = format!("{} is {width} × {height} pixels; the limit is {MAX_SIDE} × {MAX_SIDE}", shown.display());
        return Err(Diagnostic::new(codes::BUDGET, message).help(SMALLER));
    }
    budget.charge_briefly(bytes.len() as u64 + decoder.total_bytes()).map_err(|excess| refused(folder, excess))?;
    Ok(Some(decoder))
}

fn refused(folder: &Path, excess: Excess) -> Diagnostic {
    excess.diagnostic(folder.join(THUMBNAIL).display()).help(SMALLER)
}

/// What to do about a large thumbnail.
const SMALLER: &str = "`soffio render … --size 1280x720` makes one that fits";
