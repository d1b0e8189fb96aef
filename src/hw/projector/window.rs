//! A window as projector: full-screen on the monitor that was named, else an ordinary window. It lives on a thread of its own.

use std::num::NonZeroU32;
use std::rc::Rc;
use std::sync::mpsc::{Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

use softbuffer::{Context, Surface};
use winit::application::ApplicationHandler;
use winit::dpi::LogicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, EventLoop, EventLoopProxy, OwnedDisplayHandle};
use winit::monitor::MonitorHandle;
use winit::platform::{wayland, x11};
use winit::window::{Fullscreen, WindowId};

use super::{Placement, Projector, ProjectorError};
use crate::picture::{Picture, dither};

/// How long a display may take to open a window.
const PATIENCE: Duration = Duration::from_secs(10);

/// What the window's thread is told.
#[derive(Debug)]
enum Show {
    Picture(Picture),
    Dark,
    Close,
}

/// The window's pixels.
type Pixels = Surface<OwnedDisplayHandle, Rc<winit::window::Window>>;

/// What the thread says once: it is ready, on which monitor, and how to reach it; or why not.
type Opened = Result<(EventLoopProxy<Show>, String), ProjectorError>;

/// An open window.
#[derive(Debug)]
pub struct Window {
    proxy: EventLoopProxy<Show>,
    monitor: String,
    thread: Option<JoinHandle<()>>,
}

impl Window {
    /// Opens a black window: full-screen on the monitor of that name, or an ordinary one when no name is given.
    ///
    /// # Errors
    /// No display, no monitor of that name (those there are listed), or the window landed on another monitor.
    pub fn open(monitor: Option<&str>, placement: Placement) -> Result<Window, ProjectorError> {
        let placement = placement.checked()?;
        let (tell, told) = channel();
        let wanted = monitor.map(str::to_owned);
        let thread = std::thread::Builder::new()
            .name("window".into())
            .spawn(move || run(wanted, placement, &tell))
            .map_err(|error| refused(&error))?;
        let (proxy, monitor) =
            told.recv_timeout(PATIENCE).map_err(|_silent| refused(&"the display does not answer"))??;
        Ok(Window { proxy, monitor, thread: Some(thread) })
    }

    fn tell(&self, show: Show) -> Result<(), ProjectorError> {
        let lost = |_| ProjectorError::Lost { path: "window".into(), why: "it was closed".into() };
        self.proxy.send_event(show).map_err(lost)
    }
}

impl Projector for Window {
    fn present(&mut self, picture: &Picture) -> Result<(), ProjectorError> {
        self.tell(Show::Picture(picture.clone()))
    }

    fn dark(&mut self) -> Result<(), ProjectorError> {
        self.tell(Show::Dark)
    }

    fn describe(&self) -> String {
        format!("window on {}", self.monitor)
    }
}

impl Drop for Window {
    fn drop(&mut self) {
        // Closing a window leaves nothing of it on the screen.
        let _ = self.tell(Show::Close);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

fn refused(why: &dyn std::fmt::Display) -> ProjectorError {
    ProjectorError::Open { path: "window".into(), why: why.to_string() }
}

/// The window's thread.
fn run(wanted: Option<String>, placement: Placement, tell: &Sender<Opened>) {
    let mut builder = EventLoop::with_user_event();
    x11::EventLoopBuilderExtX11::with_any_thread(&mut builder, true);
    wayland::EventLoopBuilderExtWayland::with_any_thread(&mut builder, true);
    let events = match builder.build() {
        Ok(events) => events,
        Err(error) => return drop(tell.send(Err(refused(&error)))),
    };
    let proxy = events.create_proxy();
    let context = match Context::new(events.owned_display_handle()) {
        Ok(context) => context,
        Err(error) => return drop(tell.send(Err(refused(&error)))),
    };
    let mut screen = Screen { wanted, placement, tell, proxy, context, shown: None, picture: None };
    if let Err(error) = events.run_app(&mut screen) {
        // If it had opened already nobody listens any more, and the next picture finds the loop gone.
        let _ = tell.send(Err(refused(&error)));
    }
}

/// The window and what it shows.
struct Screen<'a> {
    wanted: Option<String>,
    placement: Placement,
    tell: &'a Sender<Opened>,
    proxy: EventLoopProxy<Show>,
    context: Context<OwnedDisplayHandle>,
    shown: Option<(Rc<winit::window::Window>, Pixels)>,
    picture: Option<Picture>,
}

impl Screen<'_> {
    /// Opens the window; the name of its monitor.
    fn open(&mut self, events: &ActiveEventLoop) -> Result<String, ProjectorError> {
        let monitor = self.wanted.as_deref().map(|name| find(events, name)).transpose()?;
        let attributes = winit::window::Window::default_attributes()
            .with_title("scotopic")
            .with_inner_size(LogicalSize::new(1024, 768))
            .with_fullscreen(monitor.map(|monitor| Fullscreen::Borderless(Some(monitor))));
        let window = Rc::new(events.create_window(attributes).map_err(|error| refused(&error))?);
        window.set_cursor_visible(false);
        let surface = Surface::new(&self.context, Rc::clone(&window)).map_err(|error| refused(&error))?;
        let landed = window.current_monitor().and_then(|monitor| monitor.name());
        self.shown = Some((window, surface));
        self.draw()?;
        Ok(landed.or(self.wanted.clone()).unwrap_or_else(|| "a monitor without a name".into()))
    }

    /// Whether the window stands on another monitor than the one that was named: some displays place windows as they like.
    fn astray(&self) -> Option<String> {
        let wanted = self.wanted.as_deref()?;
        let there = self.shown.as_ref()?.0.current_monitor()?.name()?;
        (there != wanted).then_some(there)
    }

    fn draw(&mut self) -> Result<(), ProjectorError> {
        let Some((window, surface)) = &mut self.shown else { return Ok(()) };
        let size = window.inner_size();
        let (Some(width), Some(height)) = (NonZeroU32::new(size.width), NonZeroU32::new(size.height)) else {
            return Ok(());
        };
        surface.resize(width, height).map_err(|error| refused(&error))?;
        let mut buffer = surface.buffer_mut().map_err(|error| refused(&error))?;
        match &self.picture {
            None => buffer.fill(0),
            Some(picture) => {
                let placed = self.placement.apply(picture, (size.width as usize, size.height as usize));
                for (pixel, light) in buffer.iter_mut().zip(dither::rgb8(&placed).chunks_exact(3)) {
                    *pixel = u32::from(light[0]) << 16 | u32::from(light[1]) << 8 | u32::from(light[2]);
                }
            }
        }
        buffer.present().map_err(|error| refused(&error))
    }
}

impl ApplicationHandler<Show> for Screen<'_> {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.shown.is_none() {
            let opened = self.open(events).map(|monitor| (self.proxy.clone(), monitor));
            if opened.is_err() {
                events.exit();
            }
            // Nobody listens when opening took too long; then the next order finds the loop gone.
            let _ = self.tell.send(opened);
        }
    }

    fn user_event(&mut self, events: &ActiveEventLoop, show: Show) {
        match show {
            // The observer's own bright screen must not get the picture.
            Show::Picture(_) if self.astray().is_some() => self.picture = None,
            Show::Picture(picture) => self.picture = Some(picture),
            Show::Dark => self.picture = None,
            Show::Close => return events.exit(),
        }
        if self.draw().is_err() {
            events.exit();
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _id: WindowId, event: WindowEvent) {
        match event {
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::RedrawRequested | WindowEvent::Resized(_) if self.draw().is_err() => events.exit(),
            _ => {}
        }
    }
}

/// The monitor of a name.
fn find(events: &ActiveEventLoop, name: &str) -> Result<MonitorHandle, ProjectorError> {
    let monitors: Vec<MonitorHandle> = events.available_monitors().collect();
    let names = || monitors.iter().filter_map(MonitorHandle::name).collect();
    monitors
        .iter()
        .find(|monitor| monitor.name().as_deref() == Some(name))
        .cloned()
        .ok_or_else(|| ProjectorError::NoMonitor { wanted: name.into(), found: names() })
}
