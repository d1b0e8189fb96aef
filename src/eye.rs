//! What the observer's eye can see, what a light costs it, and how a scene is brought to a display for it.
//!
//! ```text
//! sky, object, instrument -> background and contrast at the eye -> threshold (Crumey; Blackwell) -> reserve
//! light, time             -> pigment bleached -> loss and recovery
//! scene, display          -> tone
//! ```
//!
//! Luminances are photopic, in cd/m2 at the eye, unless a name says scotopic. Angles are in arcminutes on the sky.

/// The state of the eye: what the overlay costs while it is on, and how long until the eye is back.
pub mod adaptation;
/// Blackwell's table of threshold contrasts as Clark carries it: the second opinion.
pub mod blackwell;
/// The pigment of the rods: bleached by light, made anew in the dark.
pub mod bleach;
/// Crumey's threshold: the model.
pub mod crumey;
/// The veil of a bright point in the eye: CIE 146.
pub mod glare;
/// What of a light the rods see, and how wide it leaves the pupil.
pub mod lamp;
/// The faintest star.
pub mod limit;
/// How much brighter the Moon makes the sky.
pub mod moonlight;
/// Which magnifications show an object best.
pub mod powers;
/// How much more light a lit rod or cone needs: threshold against luminance.
pub mod rods;
/// Schaefer's limiting magnitude: the second opinion on stars.
pub mod schaefer;
/// From the luminances of a scene to those of a display.
pub mod tone;
/// Instrument and eye together: the background that the eye gets.
pub mod viewing;
/// How far an object stands above the threshold.
pub mod visibility;

pub use adaptation::Adaptation;
pub use lamp::Lamp;
pub use viewing::Viewing;
pub use visibility::{Model, Patch, Reading, Verdict};
