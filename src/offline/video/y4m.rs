//! YUV4MPEG2: uncompressed frames with a line of text before each, read by every video tool.

use std::io::{self, Write};
use std::path::Path;

use image::RgbaImage;

use super::AtomicFile;

/// A file being written.
pub(super) struct Y4m {
    file: AtomicFile,
    /// Luma coefficients of red and blue.
    shares: [f32; 2],
    planes: [Vec<u8>; 3],
}

impl Y4m {
    /// Begins a film of pictures of this width and height, in pixels.
    ///
    /// # Errors
    /// The file cannot be created.
    pub fn create(path: &Path, (width, height): (u32, u32), fps: u32) -> io::Result<Self> {
        let mut file = AtomicFile::create(path)?;
        writeln!(file, "YUV4MPEG2 W{width} H{height} F{fps}:1 Ip A1:1 C444 XCOLORRANGE=LIMITED")?;
        // The format does not name the matrix; players assume BT.709 for high definition and BT.601 below.
        let shares = if width >= 1280 || height > 576 { [0.2126, 0.0722] } else { [0.299, 0.114] };
        Ok(Self { file, shares, planes: Default::default() })
    }

    /// Writes the next picture.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn push(&mut self, picture: &RgbaImage) -> io::Result<()> {
        self.planes.iter_mut().for_each(Vec::clear);
        for pixel in picture.pixels() {
            for (plane, code) in self.planes.iter_mut().zip(codes(self.shares, [pixel[0], pixel[1], pixel[2]])) {
                plane.push(code);
            }
        }
        self.file.write_all(b"FRAME\n")?;
        self.planes.iter().try_for_each(|plane| self.file.write_all(plane))
    }

    /// Completes the file.
    ///
    /// # Errors
    /// The file cannot be written or renamed.
    pub fn finish(self) -> io::Result<()> {
        self.file.finish()
    }
}

/// Y′, C_B and C_R in 8 bits, limited range (ITU-R BT.601 2.5, BT.709 3.3): Y′ = k_r R + (1 − k_r − k_b) G + k_b B,
/// stored as 16 + 219 Y′. C_B is stored as 128 + 224 (B − Y′)/(2 − 2 k_b), and C_R likewise with R.
fn codes([red, blue]: [f32; 2], rgb: [u8; 3]) -> [u8; 3] {
    let [r, g, b] = rgb.map(|code| f32::from(code) / 255.0);
    let y = red * r + (1.0 - red - blue) * g + blue * b;
    let difference = |c: f32, share: f32| 128.0 + 112.0 * (c - y) / (1.0 - share);
    [16.0 + 219.0 * y, difference(b, blue), difference(r, red)].map(|code| (code + 0.5) as u8)
}

#[cfg(test)]
mod tests {
    use super::codes;

    #[test]
    fn white_black_and_the_primaries_have_the_codes_of_the_standards() {
        let bt601 = [0.299, 0.114];
        assert_eq!(codes(bt601, [255; 3]), [235, 128, 128]);
        assert_eq!(codes(bt601, [0; 3]), [16, 128, 128]);
        assert_eq!(codes(bt601, [255, 0, 0]), [81, 90, 240]);
        assert_eq!(codes([0.2126, 0.0722], [0, 0, 255]), [32, 240, 118]);
    }
}
