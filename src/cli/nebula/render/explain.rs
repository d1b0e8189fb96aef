//! What is told of a picture: its error, its cost, and what was left out.

use std::time::Duration;

use serde_json::{Value, json};

use super::Made;
use crate::physics::dust::develop;
use crate::physics::dust::multiple::field::Told;
use crate::physics::dust::render::{Rendered, View, Wish};

/// All that is told.
pub(super) struct Facts<'a> {
    pub(super) made: &'a Made,
    pub(super) view: &'a View,
    pub(super) wish: &'a Wish,
    pub(super) told: Option<Told>,
    pub(super) light_time: Duration,
    pub(super) against: Option<Against>,
    pub(super) files: &'a [String],
}

/// The mean radiance of each band.
pub(super) fn means(rendered: &Rendered) -> Vec<f64> {
    let mean = |plane: &Vec<f32>| plane.iter().map(|v| f64::from(*v)).sum::<f64>() / plane.len().max(1) as f64;
    rendered.radiance.iter().map(mean).collect()
}

/// How far the quick picture is from the one that leaves nothing out, in the worst pixel.
#[derive(Debug, Clone, Copy)]
pub(super) struct Against {
    /// As a share of the pixel's own light; of those darker than a hundredth of the picture's mean, of that.
    pub(super) own: f64,
    /// As a share of the picture's white, as `.png` has it where nothing is said.
    pub(super) white: f64,
    /// What the quick picture took.
    pub(super) quick: Duration,
}

/// Holds the quick picture against the slow one.
pub(super) fn difference(quick: &Made, slow: &Made) -> Against {
    let white = develop::white_of(&develop::pixels(&slow.rendered.radiance));
    let mut against = Against { own: 0.0, white: 0.0, quick: quick.time };
    let planes = quick.rendered.radiance.iter().zip(&slow.rendered.radiance);
    for ((quick, slow), mean) in planes.zip(means(&slow.rendered)) {
        for (quick, slow) in quick.iter().zip(slow) {
            let (quick, slow) = (f64::from(*quick), f64::from(*slow));
            against.own = against.own.max((quick - slow).abs() / slow.max(0.01 * mean).max(1e-300));
            against.white = against.white.max((quick - slow).abs() / white);
        }
    }
    against
}

impl Facts<'_> {
    fn seconds(&self) -> f64 {
        self.made.time.as_secs_f64()
    }

    /// One line.
    pub(super) fn short(&self) -> String {
        let e = &self.made.rendered.explained;
        let bands = means(&self.made.rendered).iter().map(|mean| format!("{mean:.6}")).collect::<Vec<_>>().join(", ");
        let mut text = format!(
            "{} scattering, {} x {} pixels: mean radiance {bands}; believed error {:.2} % in the worst pixel, {:.3} % in the mean, {:.1} s",
            self.made.name,
            self.view.width,
            self.view.height,
            100.0 * e.worst,
            100.0 * e.mean,
            self.seconds() + self.light_time.as_secs_f64(),
        );
        if self.made.model_error > 0.0 {
            let adds = if self.made.name == "multiple" { "what it adds to single scattering" } else { "its light" };
            text += &format!("; the model itself, cautiously, {:.1} % of {adds}", 100.0 * self.made.model_error);
        }
        if let Some(what) = self.made.leaves_out {
            text += &format!("\n{what}");
        }
        if let Some(Against { own, white, quick }) = self.against {
            text += &format!(
                "\nnothing left out: {:.1} s, {:.0} times as long; the quick picture is within {:.5} of white of it in every pixel (1/512 is {:.5}), and within {:.5} of\n\
                 the pixel's own light (of a hundredth of the mean, where it is darker)",
                self.seconds(),
                self.seconds() / quick.as_secs_f64().max(1e-9),
                white,
                1.0 / 512.0,
                own
            );
        }
        if e.given_up > 0 {
            text += &format!("\n{} pixels did not become as good as asked", e.given_up);
        }
        text
    }

    /// All of it.
    pub(super) fn long(&self) -> String {
        let e = &self.made.rendered.explained;
        let fine = e.fineness;
        let pixels = (self.view.width * self.view.height) as f64;
        let share = |count: u64| 100.0 * count as f64 / pixels;
        let columns = match self.made.prepared {
            Some(p) => format!(
                "from a lattice of {} spacings a side ({:.1} MiB), near the stars exact: worst error {:.1e} on the rays tried",
                p.spacings,
                p.bytes as f64 / f64::from(1 << 20),
                p.error
            ),
            None => "computed for every point: a lattice would not cost less, or not be good enough".to_owned(),
        };
        let mut text = format!(
            "{}\n\nWhat was left out, and by what bound\n\
             \x20 columns       {columns}\n\
             \x20 pieces        of at most {} voxels, {} node{} each, {:.2} rad as seen from a star, {:.2} deep: on {} rays compared with\n\
             \x20               exact ones the worst error is {:.1e}, the mean {:.1e}\n\
             \x20 empty space   {} stretches without dust passed over; {:.1} % of the pixels miss the box or its dust\n\
             \x20 opaque rays   {} of {} ended early: what could still come was below {:.0e} of what they had\n\
             \x20 pixels        {:.1} % with one ray, whose neighbours bound the error; {} round a star's image in polar order; {:.2} rays a pixel\n\
             \x20 sources       {:.3e} computed, {:.1} a ray",
            self.short(),
            fine.step,
            fine.nodes,
            if fine.nodes == 1 { "" } else { "s" },
            fine.angle,
            fine.depth,
            e.probes,
            e.worst_ray,
            e.mean_ray,
            e.tally.empty,
            share(e.missed),
            e.tally.ended,
            e.tally.rays,
            0.1 * self.wish.tolerance,
            share(e.one_ray),
            e.starred,
            e.tally.rays as f64 / pixels,
            e.tally.sources as f64,
            e.tally.sources as f64 / e.tally.rays.max(1) as f64,
        );
        if let Some(told) = self.told {
            text += &format!(
                "\n\x20 scattered before  {} photons, {} flights, {:.1} s: noise {:.2} %, harmonics beyond the highest {:.2} %, walks cut {:.1e}",
                told.photons,
                told.flights,
                self.light_time.as_secs_f64(),
                100.0 * told.noise,
                100.0 * told.beyond,
                told.cut
            );
        }
        text += &format!(
            "\nError of a pixel: asked {:.4} %, believed {:.4} % in the worst and {:.4} % in the mean ({} of its rays, the rest of its average)",
            100.0 * self.wish.tolerance,
            100.0 * e.worst,
            100.0 * e.mean,
            format_args!("{:.4} %", 100.0 * e.worst_ray),
        );
        text
    }

    /// For machines.
    pub(super) fn json(&self) -> Value {
        let e = &self.made.rendered.explained;
        json!({
            "files": self.files,
            "model": self.made.name,
            "width": self.view.width,
            "height": self.view.height,
            "mean_radiance": means(&self.made.rendered),
            "tolerance": self.wish.tolerance,
            "believed_error_worst": e.worst,
            "believed_error_mean": e.mean,
            "believed_error_rays": e.worst_ray,
            "believed_error_model": self.made.model_error,
            "model_leaves_out": self.made.leaves_out,
            "pixels_lit": e.lit,
            "pixels_one_ray": e.one_ray,
            "pixels_missed": e.missed,
            "pixels_round_stars": e.starred,
            "pixels_given_up": e.given_up,
            "rays": e.tally.rays,
            "rays_ended": e.tally.ended,
            "sources": e.tally.sources,
            "empty_stretches": e.tally.empty,
            "step_voxels": e.fineness.step,
            "nodes": e.fineness.nodes,
            "lattice_spacings": self.made.prepared.map(|p| p.spacings),
            "lattice_error": self.made.prepared.map(|p| p.error),
            "scattered_before": self.told,
            "light_s": self.light_time.as_secs_f64(),
            "picture_s": self.seconds(),
            "everything_worst_difference": self.against.map(|against| against.own),
            "everything_worst_difference_of_white": self.against.map(|against| against.white),
            "quick_picture_s": self.against.map(|against| against.quick.as_secs_f64()),
        })
    }
}
