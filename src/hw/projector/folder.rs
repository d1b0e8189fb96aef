//! Pictures into a folder: `latest.png` is always whole (written beside and renamed), numbered files keep what was shown.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::{CANVAS, Placement, Projector, ProjectorError};
use crate::picture::{Picture, png};

/// How many numbered pictures are kept: the oldest are overwritten, so that a night does not fill the disk.
const KEPT: u64 = 1000;

/// A folder of PNG files. It stands for a module that has as many pixels as the canvas.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    placement: Placement,
    number: u64,
    size: (usize, usize),
}

impl Folder {
    /// Makes the folder if it is not there, and writes a black `latest.png`.
    ///
    /// # Errors
    /// It cannot be made or written.
    pub fn open(path: &Path, placement: Placement) -> Result<Folder, ProjectorError> {
        let refused =
            |error: io::Error| ProjectorError::Open { path: path.display().to_string(), why: error.to_string() };
        fs::create_dir_all(path).map_err(refused)?;
        let placement = placement.checked()?;
        let mut folder = Folder { path: path.to_owned(), placement, number: 0, size: CANVAS };
        folder.dark()?;
        Ok(folder)
    }

    /// Writes a file so that a reader sees the old one or the new one, never half of one.
    fn write(&self, name: &str, bytes: &[u8]) -> Result<(), ProjectorError> {
        let part = self.path.join(format!("{name}.part"));
        fs::write(&part, bytes)
            .and_then(|()| fs::rename(&part, self.path.join(name)))
            .map_err(|error| self.lost(&error.to_string()))
    }

    fn lost(&self, why: &str) -> ProjectorError {
        ProjectorError::Lost { path: self.path.display().to_string(), why: why.into() }
    }

    fn encoded(&self, picture: &Picture) -> Result<Vec<u8>, ProjectorError> {
        png::encode_dithered(picture).map_err(|error| self.lost(&error.to_string()))
    }
}

impl Projector for Folder {
    fn present(&mut self, picture: &Picture) -> Result<(), ProjectorError> {
        self.size = (picture.width(), picture.height());
        let bytes = self.encoded(&self.placement.apply(picture, self.size))?;
        self.write(&format!("frame-{:04}.png", self.number % KEPT), &bytes)?;
        self.number += 1;
        self.write("latest.png", &bytes)
    }

    fn dark(&mut self) -> Result<(), ProjectorError> {
        let black = self.encoded(&Picture::black(self.size.0, self.size.1))?;
        self.write("latest.png", &black)
    }

    fn describe(&self) -> String {
        format!("PNG files in {}", self.path.display())
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // Nobody is left to tell of a failure.
        let _ = self.dark();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_black(path: &Path) -> bool {
        image::open(path).unwrap().to_rgb8().pixels().all(|pixel| pixel.0 == [0, 0, 0])
    }

    #[test]
    fn latest_is_black_at_the_start_and_at_the_end_and_each_picture_is_kept() {
        let path = std::env::temp_dir().join(format!("scotopic-folder-{}", std::process::id()));
        let mut folder = Folder::open(&path, Placement::default().mirrored(true)).unwrap();
        assert!(is_black(&path.join("latest.png")));

        let mut picture = Picture::black(8, 4);
        picture.row_mut(0)[0] = [1.0; 3];
        folder.present(&picture).unwrap();
        assert!(!is_black(&path.join("latest.png")));
        let kept = image::open(path.join("frame-0000.png")).unwrap().to_rgb8();
        assert_eq!(kept.get_pixel(7, 0).0, [255; 3], "mirrored left to right");

        drop(folder);
        assert!(is_black(&path.join("latest.png")));
        fs::remove_dir_all(&path).unwrap();
    }
}
