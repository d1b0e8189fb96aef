//! The pure part of the framebuffer: the device's numbers, checked, and pictures into its bytes.

use crate::picture::dither::Codes;

/// Sides beyond which a device is not believed.
const LONGEST_SIDE: u32 = 8192;

/// A colour's place in a pixel, as the kernel gives it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct BitField {
    /// Bits to the right of it.
    pub offset: u32,
    /// Its bits.
    pub length: u32,
    /// Not zero when its most significant bit is on the right.
    pub msb_right: u32,
}

/// What the device says of itself: the parts of `fb_var_screeninfo` and `fb_fix_screeninfo` that matter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Screen {
    /// Visible columns.
    pub xres: u32,
    /// Visible rows.
    pub yres: u32,
    /// Rows in memory.
    pub yres_virtual: u32,
    /// First visible column.
    pub xoffset: u32,
    /// First visible row.
    pub yoffset: u32,
    /// 16 or 32 are taken.
    pub bits_per_pixel: u32,
    /// Not zero when there is no colour, or a format by name.
    pub grayscale: u32,
    /// Where red is.
    pub red: BitField,
    /// Where green is.
    pub green: BitField,
    /// Where blue is.
    pub blue: BitField,
    /// 0: packed pixels.
    pub kind: u32,
    /// Bytes from one row to the next.
    pub line_length: u32,
    /// Bytes of memory.
    pub smem_len: u32,
}

/// Why a device is nothing that pictures can be written to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum GeometryError {
    /// Planes, tiles, text, grey.
    #[error("its memory is not packed colour pixels (type {kind}, grayscale {grayscale})")]
    Kind {
        /// What it is instead.
        kind: u32,
        /// And whether without colour.
        grayscale: u32,
    },
    /// Palettes and three-byte pixels.
    #[error("it has {0} bits a pixel: only 16 and 32 are understood")]
    Depth(u32),
    /// Nothing visible, or more than any projector has.
    #[error("it says that it is {0} x {1} pixels: only 1 to 8192 a side are believed")]
    Size(u32, u32),
    /// A colour outside its pixel, over another, or backwards.
    #[error("its colours make no sense: bits {0:?}")]
    Colours([(u32, u32); 3]),
    /// Rows or memory too short for what is visible.
    #[error("its memory is too small: {needed} bytes are visible and it has {there}")]
    Memory {
        /// Bytes up to the end of what is visible.
        needed: u64,
        /// Bytes there.
        there: u64,
    },
}

/// A device's geometry, checked: every visible pixel lies inside its memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Geometry {
    width: u32,
    height: u32,
    bytes_per_pixel: u32,
    line_length: u32,
    start: u64,
    colours: [BitField; 3],
}

impl Geometry {
    /// Checks what a device says of itself.
    ///
    /// # Errors
    /// What does not hold together, with its numbers.
    pub fn new(screen: &Screen) -> Result<Geometry, GeometryError> {
        if screen.kind != 0 || screen.grayscale != 0 {
            return Err(GeometryError::Kind { kind: screen.kind, grayscale: screen.grayscale });
        }
        if !matches!(screen.bits_per_pixel, 16 | 32) {
            return Err(GeometryError::Depth(screen.bits_per_pixel));
        }
        let side = 1..=LONGEST_SIDE;
        if !side.contains(&screen.xres) || !side.contains(&screen.yres) {
            return Err(GeometryError::Size(screen.xres, screen.yres));
        }
        let colours = [screen.red, screen.green, screen.blue];
        if !colours_fit(colours, screen.bits_per_pixel) {
            return Err(GeometryError::Colours(colours.map(|field| (field.offset, field.length))));
        }

        // In 64 bits no product of two of these 32-bit numbers overflows.
        let bytes_per_pixel = screen.bits_per_pixel / 8;
        let row = (u64::from(screen.xoffset) + u64::from(screen.xres)) * u64::from(bytes_per_pixel);
        if row > u64::from(screen.line_length) {
            return Err(GeometryError::Memory { needed: row, there: u64::from(screen.line_length) });
        }
        let rows = u64::from(screen.yoffset) + u64::from(screen.yres);
        if rows > u64::from(screen.yres_virtual) {
            return Err(GeometryError::Memory { needed: rows, there: u64::from(screen.yres_virtual) });
        }
        let needed = u64::from(screen.line_length) * rows;
        if needed > u64::from(screen.smem_len) {
            return Err(GeometryError::Memory { needed, there: u64::from(screen.smem_len) });
        }
        Ok(Geometry {
            width: screen.xres,
            height: screen.yres,
            bytes_per_pixel,
            line_length: screen.line_length,
            start: u64::from(screen.yoffset) * u64::from(screen.line_length)
                + u64::from(screen.xoffset) * u64::from(bytes_per_pixel),
            colours,
        })
    }

    /// Visible columns and rows.
    #[must_use]
    pub fn size(&self) -> (usize, usize) {
        (self.width as usize, self.height as usize)
    }

    /// Bits a pixel.
    #[must_use]
    pub fn bits_per_pixel(&self) -> u32 {
        self.bytes_per_pixel * 8
    }

    /// Where a visible row begins in the device's memory.
    #[must_use]
    pub fn row_start(&self, row: usize) -> u64 {
        self.start + row as u64 * u64::from(self.line_length)
    }

    /// Bytes of one visible row, without the padding behind it.
    #[must_use]
    pub fn row_bytes(&self) -> usize {
        (self.width * self.bytes_per_pixel) as usize
    }

    /// Writes row `y` of pixels, dithered, as the device wants them, least significant byte first. `row` must be as wide as
    /// the device and `bytes` [`Geometry::row_bytes`] long; what is beyond the shorter of the two stays as it was.
    pub fn encode_row(&self, y: usize, row: &[[f32; 3]], bytes: &mut [u8]) {
        let codes = self.colours.map(|field| Codes::of(field.length));
        let pixels = bytes.chunks_exact_mut(self.bytes_per_pixel as usize);
        for (x, (colour, pixel)) in row.iter().zip(pixels).enumerate() {
            let mut value = 0u32;
            for ((field, codes), &light) in self.colours.iter().zip(codes).zip(colour) {
                value |= u32::from(codes.dithered(light, x, y)) << field.offset;
            }
            pixel.copy_from_slice(&value.to_le_bytes()[..pixel.len()]);
        }
    }
}

/// Whether three colours of 1 to 8 bits lie inside a pixel, none over another, none backwards.
fn colours_fit(colours: [BitField; 3], bits: u32) -> bool {
    let mut taken = 0u64;
    colours.iter().all(|field| {
        let inside = (1..=8).contains(&field.length)
            && field.msb_right == 0
            && field.offset.checked_add(field.length).is_some_and(|end| end <= bits);
        if !inside {
            return false;
        }
        let mask = ((1u64 << field.length) - 1) << field.offset;
        let free = taken & mask == 0;
        taken |= mask;
        free
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn field(offset: u32, length: u32) -> BitField {
        BitField { offset, length, msb_right: 0 }
    }

    fn xrgb8888() -> Screen {
        Screen {
            xres: 1024,
            yres: 768,
            yres_virtual: 768,
            bits_per_pixel: 32,
            red: field(16, 8),
            green: field(8, 8),
            blue: field(0, 8),
            line_length: 4096,
            smem_len: 4096 * 768,
            ..Screen::default()
        }
    }

    fn rgb565() -> Screen {
        Screen {
            bits_per_pixel: 16,
            red: field(11, 5),
            green: field(5, 6),
            blue: field(0, 5),
            line_length: 2048 + 64,
            smem_len: (2048 + 64) * 768,
            ..xrgb8888()
        }
    }

    fn encoded(screen: &Screen, colour: [f32; 3]) -> Vec<u8> {
        let geometry = Geometry::new(screen).unwrap();
        let mut bytes = vec![0; screen.bits_per_pixel as usize / 8];
        geometry.encode_row(0, &[colour], &mut bytes);
        bytes
    }

    #[test]
    fn colours_land_in_their_bits() {
        let (red, green, blue) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
        assert_eq!(encoded(&xrgb8888(), red), [0, 0, 255, 0]);
        assert_eq!(encoded(&xrgb8888(), green), [0, 255, 0, 0]);
        assert_eq!(encoded(&rgb565(), red), [0x00, 0xF8]);
        assert_eq!(encoded(&rgb565(), green), [0xE0, 0x07]);
        assert_eq!(encoded(&rgb565(), blue), [0x1F, 0x00]);
        let bgr = Screen { red: field(0, 8), blue: field(16, 8), ..xrgb8888() };
        assert_eq!(encoded(&bgr, red), [255, 0, 0, 0]);
    }

    #[test]
    fn rows_begin_at_the_stride_not_at_the_width() {
        let geometry = Geometry::new(&Screen { yoffset: 0, ..rgb565() }).unwrap();
        assert_eq!(geometry.row_start(2), 2 * 2112);
        assert_eq!(geometry.row_bytes(), 2048);
        let panned = Screen { yoffset: 768, yres_virtual: 1536, smem_len: 4096 * 1536, ..xrgb8888() };
        assert_eq!(Geometry::new(&panned).unwrap().row_start(0), 768 * 4096);
    }

    #[test]
    fn hostile_devices_are_refused_with_their_numbers() {
        let good = xrgb8888();
        for (screen, error) in [
            (Screen { smem_len: 4096 * 767, ..good }, GeometryError::Memory { needed: 3_145_728, there: 3_141_632 }),
            (Screen { line_length: 4095, ..good }, GeometryError::Memory { needed: 4096, there: 4095 }),
            (Screen { yoffset: u32::MAX, ..good }, GeometryError::Memory { needed: 4_294_968_063, there: 768 }),
            (Screen { xres: 0, ..good }, GeometryError::Size(0, 768)),
            (Screen { xres: u32::MAX, ..good }, GeometryError::Size(u32::MAX, 768)),
            (Screen { bits_per_pixel: 8, ..good }, GeometryError::Depth(8)),
            (Screen { kind: 1, ..good }, GeometryError::Kind { kind: 1, grayscale: 0 }),
            (Screen { red: field(31, 8), ..good }, GeometryError::Colours([(31, 8), (8, 8), (0, 8)])),
            (Screen { red: field(u32::MAX, 2), ..good }, GeometryError::Colours([(u32::MAX, 2), (8, 8), (0, 8)])),
            (Screen { red: field(8, 8), ..good }, GeometryError::Colours([(8, 8), (8, 8), (0, 8)])),
        ] {
            assert_eq!(Geometry::new(&screen), Err(error));
        }
    }

    fn any_number() -> impl Strategy<Value = u32> {
        prop_oneof![0..3u32, 700..1100u32, any::<u32>(), Just(u32::MAX)]
    }

    prop_compose! {
        fn any_screen()(
            n in prop::array::uniform8(any_number()),
            bits in prop_oneof![Just(16), Just(32), any::<u32>()],
            offsets in prop::array::uniform3(0..40u32), lengths in prop::array::uniform3(0..10u32),
        ) -> Screen {
            let at = |i: usize| field(offsets[i], lengths[i]);
            Screen { xres: n[0], yres: n[1], yres_virtual: n[2], xoffset: n[3] % 5, yoffset: n[4], bits_per_pixel: bits,
                red: at(0), green: at(1), blue: at(2), line_length: n[5], smem_len: n[6].max(n[7]),
                ..Screen::default() }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4096))]

        #[test]
        fn whatever_a_device_says_nothing_is_written_outside_its_memory(screen in any_screen()) {
            if let Ok(geometry) = Geometry::new(&screen) {
                let (_, height) = geometry.size();
                let end = geometry.row_start(height - 1) + geometry.row_bytes() as u64;
                prop_assert!(end <= u64::from(screen.smem_len));
                prop_assert!(geometry.row_bytes() <= screen.line_length as usize);
                let mut bytes = vec![0; geometry.row_bytes()];
                geometry.encode_row(0, &vec![[1.0; 3]; screen.xres as usize], &mut bytes);
            }
        }
    }
}
