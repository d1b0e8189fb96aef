//! A window as projector: full-screen on the monitor that was named, else an ordinary window. It lives on a thread of its own,
//! and stays black wherever else the display has put it.

use std::num::NonZeroU32;
use std::rc::Rc;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use softbuffer::{Context, Surface};
use winit::application::ApplicationHandler;
use winit::dpi::LogicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy, OwnedDisplayHandle};
use winit::monitor::MonitorHandle;
use winit::platform::{wayland, x11};
use winit::window::{Fullscreen, WindowId};

use super::landing::{self, Astray, Place};
use super::{Placement, Projector, ProjectorError};
use crate::picture::{Picture, dither};

/// How long a display may take to open a window.
const PATIENCE: Duration = Duration::from_secs(10);

/// A window manager may take so long to put a window where it belongs.
const SETTLING: Duration = Duration::from_secs(3);

/// Until then it is looked at so often.
const LOOK: Duration = Duration::from_millis(20);

/// What came of showing something.
type Done = Result<(), ProjectorError>;

/// What the window's thread is told, and whom it tells when that is done.
#[derive(Debug)]
enum Show {
    Picture(Picture, Sender<Done>),
    Dark(Sender<Done>),
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

    /// Tells the thread, and waits until the window shows it.
    fn ask(&self, show: impl FnOnce(Sender<Done>) -> Show) -> Done {
        let (tell, told) = channel();
        self.proxy.send_event(show(tell)).map_err(|_closed| lost("it was closed"))?;
        told.recv_timeout(PATIENCE).unwrap_or_else(|error| {
            Err(lost(match error {
                RecvTimeoutError::Timeout => "the display does not answer",
                RecvTimeoutError::Disconnected => "it was closed",
            }))
        })
    }
}

impl Projector for Window {
    fn present(&mut self, picture: &Picture) -> Result<(), ProjectorError> {
        self.ask(|tell| Show::Picture(picture.clone(), tell))
    }

    fn dark(&mut self) -> Result<(), ProjectorError> {
        self.ask(Show::Dark)
    }

    fn describe(&self) -> String {
        format!("window on {}", self.monitor)
    }
}

impl Drop for Window {
    fn drop(&mut self) {
        // Closing a window leaves nothing of it on the screen.
        let _ = self.proxy.send_event(Show::Close);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

fn lost(why: &str) -> ProjectorError {
    ProjectorError::Lost { path: "window".into(), why: why.into() }
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
    let mut screen =
        Screen { wanted, placement, tell, proxy, context, shown: None, picture: None, settling_since: None };
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
    /// Since when the window is open and its place is waited for; none once it has been told.
    settling_since: Option<Instant>,
}

impl Screen<'_> {
    /// Opens the window, black.
    fn open(&mut self, events: &ActiveEventLoop) -> Done {
        let monitor = self.wanted.as_deref().map(|name| find(events, name)).transpose()?;
        let mut attributes = winit::window::Window::default_attributes().with_title("scotopic");
        attributes = match monitor {
            // Position and size too: where there is no window manager nobody else makes it fill its monitor.
            Some(monitor) => attributes
                .with_position(monitor.position())
                .with_inner_size(monitor.size())
                .with_decorations(false)
                .with_fullscreen(Some(Fullscreen::Borderless(Some(monitor)))),
            None => attributes.with_inner_size(LogicalSize::new(1024, 768)),
        };
        let window = Rc::new(events.create_window(attributes).map_err(|error| refused(&error))?);
        window.set_cursor_visible(false);
        let surface = Surface::new(&self.context, Rc::clone(&window)).map_err(|error| refused(&error))?;
        self.shown = Some((window, surface));
        self.draw()
    }

    /// Whether the window is on the monitor that was named; without a name it is right anywhere.
    fn judged(&self) -> Result<(), Astray> {
        let (Some(wanted), Some((window, _))) = (self.wanted.as_deref(), &self.shown) else { return Ok(()) };
        let Ok(corner) = window.inner_position() else {
            let landed = window.current_monitor().and_then(|monitor| monitor.name());
            return landing::judge_by_name(landed.as_deref(), wanted);
        };
        let monitors: Vec<(String, Place)> = window
            .available_monitors()
            .filter_map(|monitor| {
                let (corner, size) = (monitor.position(), monitor.size());
                let place = Place { left: corner.x, top: corner.y, width: size.width, height: size.height };
                Some((monitor.name()?, place))
            })
            .collect();
        let size = window.inner_size();
        let place = Place { left: corner.x, top: corner.y, width: size.width, height: size.height };
        landing::judge(&monitors, place, wanted)
    }

    /// Tells that the window is open once it is where it belongs, or why it never came there.
    fn settle(&mut self, events: &ActiveEventLoop) {
        let Some(since) = self.settling_since else { return };
        let opened = match self.judged() {
            Ok(()) => {
                let there = self.shown.as_ref().and_then(|(window, _)| window.current_monitor()?.name());
                let name = self.wanted.clone().or(there).unwrap_or_else(|| "a monitor without a name".into());
                Ok((self.proxy.clone(), name))
            }
            Err(_) if since.elapsed() < SETTLING => {
                return events.set_control_flow(ControlFlow::WaitUntil(Instant::now() + LOOK));
            }
            Err(astray) => {
                events.exit();
                Err(ProjectorError::Astray(astray))
            }
        };
        self.settling_since = None;
        events.set_control_flow(ControlFlow::Wait);
        // Nobody listens when opening took too long; then the next order finds the loop gone.
        let _ = self.tell.send(opened);
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
        if self.shown.is_some() {
            return;
        }
        match self.open(events) {
            Ok(()) => self.settling_since = Some(Instant::now()),
            Err(error) => {
                events.exit();
                let _ = self.tell.send(Err(error));
            }
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        self.settle(events);
    }

    fn user_event(&mut self, events: &ActiveEventLoop, show: Show) {
        let (picture, told) = match show {
            Show::Picture(picture, told) => (Some(picture), told),
            Show::Dark(told) => (None, told),
            Show::Close => return events.exit(),
        };
        // The observer's own bright screen must not get the picture.
        let judged = if picture.is_some() { self.judged() } else { Ok(()) };
        self.picture = picture.filter(|_| judged.is_ok());
        let drawn = self.draw();
        if drawn.is_err() {
            events.exit();
        }
        // Who has waited too long is gone.
        let _ = told.send(drawn.and(judged.map_err(ProjectorError::Astray)));
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _id: WindowId, event: WindowEvent) {
        match event {
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::Moved(_) | WindowEvent::Resized(_) if self.judged().is_err() => {
                self.picture = None;
                if self.draw().is_err() {
                    events.exit();
                }
            }
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
