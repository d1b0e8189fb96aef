//! The Linux framebuffer device. Rows are written at their offset (`pwrite`), which every framebuffer driver takes and which
//! needs no mapped memory.

use std::fs::{File, OpenOptions};
use std::os::unix::fs::FileExt;
use std::path::Path;

use super::geometry::{Geometry, Screen};
use super::{CANVAS, Placement, Projector, ProjectorError, ioctl};
use crate::picture::Picture;

/// An open framebuffer.
#[derive(Debug)]
pub struct Framebuffer {
    device: File,
    path: String,
    geometry: Geometry,
    placement: Placement,
    /// The bytes that each visible row shows now; only rows that change are written.
    shown: Vec<Option<Vec<u8>>>,
}

impl Framebuffer {
    /// Opens a device, asks its geometry, and makes it dark.
    ///
    /// # Errors
    /// It is not there, may not be opened, is no framebuffer, or has a geometry that cannot be written to.
    pub fn open(path: &Path, placement: Placement) -> Result<Framebuffer, ProjectorError> {
        let refused = |why: String| ProjectorError::Open { path: path.display().to_string(), why };
        let device =
            OpenOptions::new().read(true).write(true).open(path).map_err(|error| refused(error.to_string()))?;
        let screen = ioctl::screen(&device)
            .map_err(|error| refused(format!("it is no framebuffer ({error}); is it the right device?")))?;
        let framebuffer = Framebuffer::with_screen(device, path, &screen, placement)?;
        // Only now, when it is black. A driver that cannot blank has nothing to wake.
        let _ = ioctl::unblank(&framebuffer.device);
        Ok(framebuffer)
    }

    /// A device, or in tests a plain file, of known geometry.
    ///
    /// # Errors
    /// The geometry does not hold together, or the device does not take black.
    fn with_screen(
        device: File,
        path: &Path,
        screen: &Screen,
        placement: Placement,
    ) -> Result<Framebuffer, ProjectorError> {
        let path = path.display().to_string();
        let geometry = Geometry::new(screen).map_err(|why| ProjectorError::Geometry { path: path.clone(), why })?;
        let placement = placement.seen(CANVAS, geometry.size())?;
        let shown = vec![None; geometry.size().1];
        let mut framebuffer = Framebuffer { device, path, geometry, placement, shown };
        framebuffer.dark()?;
        Ok(framebuffer)
    }

    fn write_row(&mut self, row: usize, bytes: Vec<u8>) -> Result<(), ProjectorError> {
        if self.shown[row].as_ref() == Some(&bytes) {
            return Ok(());
        }
        // Forgotten first: a row of which half was written is written again.
        self.shown[row] = None;
        self.device
            .write_all_at(&bytes, self.geometry.row_start(row))
            .map_err(|error| ProjectorError::Lost { path: self.path.clone(), why: error.to_string() })?;
        self.shown[row] = Some(bytes);
        Ok(())
    }
}

impl Projector for Framebuffer {
    fn present(&mut self, picture: &Picture) -> Result<(), ProjectorError> {
        let placed = self.placement.apply(picture, self.geometry.size());
        for row in 0..placed.height() {
            let mut bytes = vec![0; self.geometry.row_bytes()];
            self.geometry.encode_row(row, placed.row(row), &mut bytes);
            self.write_row(row, bytes)?;
        }
        Ok(())
    }

    fn dark(&mut self) -> Result<(), ProjectorError> {
        // Every row is tried, also after one failed.
        (0..self.shown.len())
            .map(|row| self.write_row(row, vec![0; self.geometry.row_bytes()]))
            .fold(Ok(()), Result::and)
    }

    fn describe(&self) -> String {
        let (width, height) = self.geometry.size();
        format!("framebuffer {}, {width} x {height}, {} bit", self.path, self.geometry.bits_per_pixel())
    }
}

impl Drop for Framebuffer {
    fn drop(&mut self) {
        // Nobody is left to tell of a failure.
        let _ = self.dark();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hw::projector::geometry::BitField;

    fn screen() -> Screen {
        let field = |offset, length| BitField { offset, length, msb_right: 0 };
        Screen {
            xres: 4,
            yres: 3,
            yres_virtual: 3,
            bits_per_pixel: 16,
            red: field(11, 5),
            green: field(5, 6),
            blue: field(0, 5),
            line_length: 12,
            smem_len: 36,
            ..Screen::default()
        }
    }

    #[test]
    fn a_picture_reaches_the_visible_bytes_only_and_black_is_left_behind() {
        let path = std::env::temp_dir().join(format!("scotopic-fb-{}", std::process::id()));
        std::fs::write(&path, [0x55; 36]).unwrap();
        let open = || OpenOptions::new().read(true).write(true).open(&path).unwrap();
        let mut framebuffer = Framebuffer::with_screen(open(), &path, &screen(), Placement::default()).unwrap();
        let dark = [[0; 8].as_slice(), &[0x55; 4]].concat().repeat(3);
        assert_eq!(std::fs::read(&path).unwrap(), dark, "dark when opened, padding untouched");

        let mut picture = Picture::black(4, 3);
        picture.row_mut(1)[0] = [1.0, 0.0, 0.0];
        framebuffer.present(&picture).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        assert_eq!(bytes[12..14], [0x00, 0xF8]);
        assert_eq!(bytes.iter().filter(|b| **b == 0x55).count(), 12);

        drop(framebuffer);
        assert_eq!(std::fs::read(&path).unwrap(), dark, "dark when dropped");
        std::fs::remove_file(&path).unwrap();
    }

    #[test]
    fn a_plain_file_is_no_framebuffer() {
        let path = std::env::temp_dir().join(format!("scotopic-nofb-{}", std::process::id()));
        std::fs::write(&path, [0; 64]).unwrap();
        let error = Framebuffer::open(&path, Placement::default()).unwrap_err().to_string();
        std::fs::remove_file(&path).unwrap();
        assert!(error.contains("no framebuffer"), "{error}");
    }
}
