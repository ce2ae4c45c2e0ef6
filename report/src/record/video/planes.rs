//! Converts pictures to the planes of video: a brightness for each pixel, and a colour for each square of four pixels.

/// The number of lines from which on players assume the colours of HDTV if a video does not say which colours it has.
const HIGH_DEFINITION: u32 = 720;

/// The planes of one picture: brightness Y and the colour differences Cb and Cr, in the range of television: 16 to 235
/// for Y, 16 to 240 for Cb and Cr.
pub(super) struct Planes {
    /// The shown width and height of the picture, in pixels. `size` holds those of the picture, which are even.
    shown: [usize; 2],
    size: [usize; 2],
    matrix: Matrix,
    y: Vec<u8>,
    cb: Vec<u8>,
    cr: Vec<u8>,
}

/// The shares of red and blue in the brightness; the rest is green.
struct Matrix {
    red: f32,
    blue: f32,
    /// The number that identifies the colour matrix in files (ITU-T H.273, table 4).
    code: u16,
}

/// The matrices of ITU-R BT.601 and of BT.709. Players that look only at the size choose between the two in the same
/// way.
const STANDARD: Matrix = Matrix { red: 0.299, blue: 0.114, code: 6 };
const HIGH: Matrix = Matrix { red: 0.2126, blue: 0.0722, code: 1 };

impl Planes {
    /// Makes the colour planes of a picture with a width and a height in pixels.
    pub fn new(shown: [u32; 2]) -> Self {
        let matrix = if shown[1] < HIGH_DEFINITION { STANDARD } else { HIGH };
        let shown = shown.map(|pixels| pixels as usize);
        let size = shown.map(|pixels| pixels.next_multiple_of(2));
        let pixels = size[0] * size[1];
        Self { shown, size, matrix, y: vec![0; pixels], cb: vec![0; pixels / 4], cr: vec![0; pixels / 4] }
    }

    /// Returns the width and the height of the stored picture in pixels, which are even.
    pub fn size(&self) -> [u32; 2] {
        self.size.map(|pixels| pixels as u32)
    }

    /// Returns the number that identifies the colour matrix in files.
    pub fn matrix_code(&self) -> u16 {
        self.matrix.code
    }

    /// Returns the colour planes Y, Cb and Cr of the picture.
    pub fn all(&self) -> [&[u8]; 3] {
        [&self.y, &self.cb, &self.cr]
    }

    /// Converts a picture, given as red, green and blue of each pixel, to the colour planes. Pixels beyond an odd width
    /// or height repeat their neighbours.
    pub fn take(&mut self, rgb: &[u8]) {
        let Matrix { red, blue, .. } = self.matrix;
        let [across, down] = self.shown;
        let [width, height] = self.size;
        for row in (0..height).step_by(2) {
            for column in (0..width).step_by(2) {
                let mut differences = [0.0; 2];
                for (x, y) in [(column, row), (column + 1, row), (column, row + 1), (column + 1, row + 1)] {
                    let from = 3 * (y.min(down - 1) * across + x.min(across - 1));
                    let [r, g, b] = [0, 1, 2].map(|part| f32::from(rgb[from + part]) / 255.0);
                    let bright = red * r + (1.0 - red - blue) * g + blue * b;
                    self.y[y * width + x] = (16.0 + 219.0 * bright).round() as u8;
                    differences[0] += (b - bright) / (1.0 - blue);
                    differences[1] += (r - bright) / (1.0 - red);
                }
                let [cb, cr] = differences.map(|sum: f32| (128.0 + 112.0 * sum / 4.0).round() as u8);
                let square = row / 2 * (width / 2) + column / 2;
                (self.cb[square], self.cr[square]) = (cb, cr);
            }
        }
    }
}
