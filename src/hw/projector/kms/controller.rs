//! The calls into the kernel: two dumb buffers and page flips. What is taken is decided in `plan`, and `flip` draws.

use std::fs::{File, OpenOptions};
use std::io;
use std::os::fd::{AsFd, BorrowedFd};
use std::path::{Path, PathBuf};

use drm::Device as _;
use drm::buffer::{Buffer as _, DrmFourcc};
use drm::control::dumbbuffer::DumbBuffer;
use drm::control::{Device as _, Event, Mode, ModeTypeFlags, PageFlipFlags, ResourceHandles};
use drm::control::{connector, crtc, framebuffer};
use rustix::event::{PollFd, PollFlags, poll};
use rustix::time::Timespec;

use super::plan::{self, Card, Connector, ModeLine, Wanted};
use crate::hw::projector::flip::{Buffers, Flipping};
use crate::hw::projector::geometry::Geometry;
use crate::hw::projector::{Placement, ProjectorError};

/// A flip that has not happened after so many seconds does not happen.
const PATIENCE_S: i64 = 1;

/// The controller's device file.
#[derive(Debug)]
struct Controller(File);

impl AsFd for Controller {
    fn as_fd(&self) -> BorrowedFd<'_> {
        self.0.as_fd()
    }
}

impl drm::Device for Controller {}
impl drm::control::Device for Controller {}

/// Two buffers of a display controller.
#[derive(Debug)]
pub struct Kms {
    controller: Controller,
    name: String,
    geometry: Geometry,
    crtc: crtc::Handle,
    connector: connector::Handle,
    mode: Mode,
    buffers: [DumbBuffer; 2],
    frames: [framebuffer::Handle; 2],
    /// A flip was asked and has not been heard of.
    pending: bool,
    /// The mode must be set (again): at the start, and after another program had the display.
    unset: bool,
}

/// Opens a connector, and makes it dark.
///
/// # Errors
/// No such connector, nothing connected to it, another program has the display: the sentence says what to do.
pub fn open(wanted: &Wanted, placement: Placement) -> Result<Flipping<Kms>, ProjectorError> {
    let mut kms = Kms::open(wanted)?;
    // Both are black before the first of them is on the screen.
    let black = vec![0; kms.geometry.row_bytes()];
    let rows: Vec<_> = (0..kms.geometry.size().1).map(|y| (y, black.clone())).collect();
    for buffer in 0..2 {
        kms.write(buffer, &rows).map_err(|why| ProjectorError::Open { path: wanted.to_string(), why })?;
    }
    Flipping::new(kms, placement)
}

impl Kms {
    fn open(wanted: &Wanted) -> Result<Kms, ProjectorError> {
        let refused = |what: &str, error: io::Error| ProjectorError::Open {
            path: wanted.to_string(),
            why: format!("{what}: {}", plan::advised(&error)),
        };
        let (cards, closed) = cards();
        let described: Vec<Card> = cards.iter().map(|card| card.described.clone()).collect();
        let chosen = plan::plan(&described, &closed, wanted)?;
        let OpenCard { controller, resources, connectors, .. } =
            cards.into_iter().nth(chosen.card).ok_or(plan::KmsError::NoController)?;
        let connector = &connectors[chosen.connector];
        let (mode, crtc) = (connector.modes()[chosen.mode], resources.crtcs()[chosen.crtc]);

        // Being the first to open the file usually makes master; where not, it is asked for, and refused with a reason.
        controller.acquire_master_lock().map_err(|error| refused("the display is not free", error))?;
        let (width, height) = mode.size();
        let make = || controller.create_dumb_buffer((width.into(), height.into()), DrmFourcc::Xrgb8888, 32);
        let buffers = [make(), make()].map(|made| made.map_err(|error| refused("no memory for pictures", error)));
        let [first, second] = buffers;
        let buffers = [first?, second?];
        let geometry = plan::geometry(buffers[0].size(), buffers[0].pitch())
            .map_err(|why| ProjectorError::Geometry { path: wanted.to_string(), why })?;
        if buffers[1].pitch() != buffers[0].pitch() {
            return Err(refused("two buffers of one size differ", io::ErrorKind::InvalidData.into()));
        }
        let frame = |buffer: &DumbBuffer| {
            controller.add_framebuffer(buffer, 24, 32).map_err(|error| refused("32-bit pixels are not taken", error))
        };
        let frames = [frame(&buffers[0])?, frame(&buffers[1])?];
        let hz = mode.vrefresh();
        let name = format!("{} on {}, {width} x {height}, {hz} Hz", connector, described[chosen.card].name);
        let connector = connector.handle();
        Ok(Kms { controller, name, geometry, crtc, connector, mode, buffers, frames, pending: false, unset: true })
    }

    /// Hears of the flip that was asked.
    fn hear(&mut self) -> Result<(), String> {
        while self.pending {
            let mut waiting = [PollFd::new(&self.controller, PollFlags::IN)];
            let patience = Timespec { tv_sec: PATIENCE_S, tv_nsec: 0 };
            match poll(&mut waiting, Some(&patience)) {
                Ok(0) => return Err(format!("the picture was not shown within {PATIENCE_S} s; is the cable in?")),
                Ok(_) => {}
                Err(rustix::io::Errno::INTR) => continue,
                Err(error) => return Err(error.to_string()),
            }
            let mut events = self.controller.receive_events().map_err(|error| plan::advised(&error))?;
            if events.any(|event| matches!(event, Event::PageFlip(flip) if flip.crtc == self.crtc)) {
                self.pending = false;
            }
        }
        Ok(())
    }
}

impl Buffers for Kms {
    fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    fn write(&mut self, buffer: usize, rows: &[(usize, Vec<u8>)]) -> Result<(), String> {
        let mut memory =
            self.controller.map_dumb_buffer(&mut self.buffers[buffer]).map_err(|error| plan::advised(&error))?;
        for (y, bytes) in rows {
            let start = usize::try_from(self.geometry.row_start(*y)).unwrap_or(usize::MAX);
            if let Some(row) = memory.get_mut(start..).and_then(|rest| rest.get_mut(..bytes.len())) {
                row.copy_from_slice(bytes);
            }
        }
        Ok(())
    }

    fn flip(&mut self, buffer: usize) -> Result<(), String> {
        self.hear()?;
        let frame = self.frames[buffer];
        if self.unset {
            let set = |controller: &Controller| {
                controller.set_crtc(self.crtc, Some(frame), (0, 0), &[self.connector], Some(self.mode))
            };
            // After another program had the display: master again, then the mode.
            set(&self.controller)
                .or_else(|_| self.controller.acquire_master_lock().and_then(|()| set(&self.controller)))
                .map_err(|error| plan::advised(&error))?;
            self.unset = false;
            return Ok(());
        }
        let asked = self.controller.page_flip(self.crtc, frame, PageFlipFlags::EVENT, None);
        if let Err(error) = asked {
            self.unset = true;
            return Err(plan::advised(&error));
        }
        self.pending = true;
        self.hear()
    }

    fn describe(&self) -> String {
        self.name.clone()
    }
}

impl Drop for Kms {
    fn drop(&mut self) {
        // No signal is darker than a black picture. What comes after is the console's: docs/hardware/projector.md.
        let _ = self.controller.set_crtc(self.crtc, None, (0, 0), &[], None);
        for frame in self.frames {
            let _ = self.controller.destroy_framebuffer(frame);
        }
        for buffer in self.buffers {
            let _ = self.controller.destroy_dumb_buffer(buffer);
        }
    }
}

/// A controller that could be opened, and what it says of itself.
struct OpenCard {
    controller: Controller,
    resources: ResourceHandles,
    connectors: Vec<connector::Info>,
    described: Card,
}

/// All controllers, and those that could not be opened, with the reason.
fn cards() -> (Vec<OpenCard>, Vec<(String, String)>) {
    let mut paths: Vec<PathBuf> =
        std::fs::read_dir("/dev/dri").into_iter().flatten().flatten().map(|entry| entry.path()).collect();
    paths.retain(|path| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("card")));
    paths.sort();
    let (mut opened, mut closed) = (Vec::new(), Vec::new());
    for path in paths {
        match card(&path) {
            Ok(card) => opened.push(card),
            Err(error) => closed.push((path.display().to_string(), plan::advised(&error))),
        }
    }
    (opened, closed)
}

fn card(path: &Path) -> io::Result<OpenCard> {
    let controller = Controller(OpenOptions::new().read(true).write(true).open(path)?);
    let resources = controller.resource_handles()?;
    let crtcs = resources.crtcs();
    let place = |handle: crtc::Handle| crtcs.iter().position(|own| *own == handle);
    let mut infos = Vec::new();
    let mut connectors = Vec::new();
    for handle in resources.connectors() {
        let info = controller.get_connector(*handle, true)?;
        let encoders: Vec<_> =
            info.encoders().iter().filter_map(|encoder| controller.get_encoder(*encoder).ok()).collect();
        let current = info.current_encoder().and_then(|encoder| controller.get_encoder(encoder).ok()?.crtc());
        let possible =
            encoders.iter().flat_map(|encoder| resources.filter_crtcs(encoder.possible_crtcs())).filter_map(place);
        connectors.push(Connector {
            name: info.to_string(),
            connected: info.state() == connector::State::Connected,
            modes: info.modes().iter().map(mode_line).collect(),
            possible: possible.collect(),
            current: current.and_then(place),
        });
        infos.push(info);
    }
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    Ok(OpenCard { controller, resources, connectors: infos, described: Card { name, connectors } })
}

fn mode_line(mode: &Mode) -> ModeLine {
    let (width, height) = mode.size();
    let preferred = mode.mode_type().contains(ModeTypeFlags::PREFERRED);
    ModeLine { width: width.into(), height: height.into(), hz: mode.vrefresh(), preferred }
}
