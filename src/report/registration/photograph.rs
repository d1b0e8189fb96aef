//! Photographs of a Moon that never was, for which everything is known: made of pixels, and sharing nothing with what measures
//! them.

use crate::numerics::streams::Stream;

/// What is photographed, and how.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Photographed {
    /// The middle of the disc, pixels from the upper left.
    pub middle: (f64, f64),
    /// Half the disc's width, pixels.
    pub radius: f64,
    /// Clockwise turn of the Moon in the picture, degrees.
    pub turned_deg: f64,
    /// Left and right exchanged before the turn.
    pub mirrored: bool,
    /// How much flatter the air makes it, across the picture's vertical.
    pub flattening: f64,
    /// Angle at the Moon between Sun and observer: 0 full, 90 quarter.
    pub phase_deg: f64,
    /// Mountains and valleys of the limb, arcseconds at most.
    pub relief_arcsec: f64,
    /// Maria and craters, or a plain disc.
    pub maria: bool,
    /// Brightness of a full, flat Moon.
    pub exposure: f64,
    /// Standard deviation of the blur, pixels.
    pub blur_px: f64,
    /// Standard deviation of the noise, of full white.
    pub noise: f64,
    /// The camera's curve: brightness to this power.
    pub tone: f64,
}

impl Default for Photographed {
    /// A Moon of 800 pixels as the calibration is asked to take it: blur 2 pixels, noise 5 %, relief 2 arcseconds.
    fn default() -> Photographed {
        Photographed {
            middle: (450.0, 450.0),
            radius: 400.0,
            turned_deg: 0.0,
            mirrored: false,
            flattening: 0.0,
            phase_deg: 60.0,
            relief_arcsec: 2.0,
            maria: true,
            exposure: 0.75,
            blur_px: 2.0,
            noise: 0.05,
            tone: 1.0,
        }
    }
}

/// The Moon's radius in arcseconds at its mean distance.
const RADIUS_ARCSEC: f64 = 932.6;

/// Steps round the limb.
const HEIGHTS: usize = 4096;

/// A face and a limb drawn by chance: darker maria, brighter craters, mountains.
#[derive(Debug, Clone)]
pub struct Face {
    /// Place, radius and brightness of spots.
    spots: Vec<[f64; 4]>,
    /// Height of the limb round the disc, -1 to 1, in equal steps.
    limb: Vec<f64>,
}

impl Face {
    /// The face of a seed.
    #[must_use]
    pub fn of(seed: u64) -> Face {
        let mut stream = Stream::part(seed, 0);
        let mut within = |low: f64, high: f64| low + (high - low) * stream.uniform();
        let mut spots = Vec::new();
        for k in 0..420 {
            let (low, high, depth) = match k {
                0..14 => (0.08, 0.25, -0.35),
                14..90 => (0.015, 0.05, 0.15),
                _ => (0.006, 0.02, 0.2),
            };
            let depth = depth * within(0.5, 1.2);
            spots.push([within(-1.0, 1.0), within(-1.0, 1.0), within(low, high), depth]);
        }
        // The amplitude falls with the length of the wave as the limb's own does, about k^-0.7.
        let waves: Vec<(f64, f64)> = (3..140)
            .map(|k| (f64::from(k).powf(-0.7) * within(-1.0, 1.0), within(0.0, std::f64::consts::TAU)))
            .collect();
        let height = |angle: f64| -> f64 {
            waves.iter().zip(3..).map(|((amplitude, phase), k)| amplitude * (f64::from(k) * angle + phase).cos()).sum()
        };
        let limb: Vec<f64> = (0..HEIGHTS).map(|k| height(k as f64 / HEIGHTS as f64 * std::f64::consts::TAU)).collect();
        let highest = limb.iter().fold(1e-9, |most: f64, height| most.max(height.abs()));
        let limb = limb.iter().map(|height| height / highest).collect();
        Face { spots, limb }
    }

    /// The photograph, `width` x `height`: brightness row by row, 0 to 1, in 256 steps.
    #[must_use]
    pub fn photographed(&self, how: &Photographed, width: usize, height: usize, seed: u64) -> Vec<f32> {
        let light = self.lit(how, width, height);
        let blurred = blurred(&light, width, height, how.blur_px);
        let mut stream = Stream::part(seed, 1);
        let toned = |light: f32| f64::from(light).clamp(0.0, 1.0).powf(how.tone);
        let noisy = blurred.iter().map(|light| toned(*light) + how.noise * normal(&mut stream));
        noisy.map(|value| ((value.clamp(0.0, 1.0) * 255.0).round() / 255.0) as f32).collect()
    }

    /// Light of each pixel before blur: nine places in each near the limb, one elsewhere.
    fn lit(&self, how: &Photographed, width: usize, height: usize) -> Vec<f32> {
        let map = self.map();
        let (sin, cos) = how.turned_deg.to_radians().sin_cos();
        let sun = how.phase_deg.to_radians().sin_cos();
        let mut light = vec![0.0f32; width * height];
        for y in 0..height {
            for x in 0..width {
                let shine = |px: f64, py: f64| {
                    let (dx, dy) = ((px - how.middle.0) / how.radius, (py - how.middle.1) / how.radius);
                    let dy = dy / (1.0 - how.flattening);
                    let u = (dx * cos + dy * sin) * if how.mirrored { -1.0 } else { 1.0 };
                    self.shine(how, &map, u, dy * cos - dx * sin, sun)
                };
                let (px, py) = (x as f64 + 0.5, y as f64 + 0.5);
                let away = (px - how.middle.0).hypot((py - how.middle.1) / (1.0 - how.flattening)) / how.radius;
                light[y * width + x] = if (away - 1.0).abs() * how.radius < 4.0 {
                    let part = |k: usize| ((k % 5) as f64 * 0.2 - 0.4, (k / 5) as f64 * 0.2 - 0.4);
                    ((0..25).map(part).map(|(a, b)| shine(px + a, py + b)).sum::<f64>() / 25.0) as f32
                } else if away < 1.0 {
                    shine(px, py) as f32
                } else {
                    0.0
                };
            }
        }
        light
    }

    /// Light at a place on the disc, y down, the Sun on the right: Lommel and Seeliger's law, `2 mu0 / (mu0 + mu)`.
    fn shine(&self, how: &Photographed, map: &[f32], u: f64, v: f64, (sun_sin, sun_cos): (f64, f64)) -> f64 {
        let away = u.hypot(v);
        let relief = how.relief_arcsec / RADIUS_ARCSEC;
        if away > 1.0 + relief || away > 1.0 + relief * self.height(v.atan2(u)) {
            return 0.0;
        }
        let mu = (1.0 - away * away).max(1e-4).sqrt();
        let incident = (sun_sin * u + sun_cos * mu).max(0.0);
        let shaded = how.exposure * (2.0 * incident / (incident + mu)).min(1.2);
        if !how.maria {
            return shaded;
        }
        // Between cells, bilinear: the nearest cell's would shift what is seen by up to half a cell, slowly varying over the disc.
        let cell = |w: f64| ((w + 1.0) * 512.0 - 0.5).clamp(0.0, 1022.0);
        let (x, y) = (cell(u), cell(v));
        let at = |right: usize, down: usize| f64::from(map[(y as usize + down) * 1024 + x as usize + right]);
        let (s, t) = (x.fract(), y.fract());
        let upper = at(0, 0) * (1.0 - s) + at(1, 0) * s;
        let lower = at(0, 1) * (1.0 - s) + at(1, 1) * s;
        shaded * (upper * (1.0 - t) + lower * t)
    }

    /// Height of the limb in a direction, -1 to 1.
    fn height(&self, angle: f64) -> f64 {
        let place = angle.rem_euclid(std::f64::consts::TAU) / std::f64::consts::TAU * HEIGHTS as f64;
        let (from, part) = (place as usize, place.fract());
        self.limb[from % HEIGHTS] * (1.0 - part) + self.limb[(from + 1) % HEIGHTS] * part
    }

    /// Reflectance over the disc, 1024 cells a side.
    fn map(&self) -> Vec<f32> {
        let mut map = vec![1.0f32; 1024 * 1024];
        for [u, v, radius, depth] in &self.spots {
            let reach = 3.0 * radius;
            let ends = |w: f64| {
                let cell = |w: f64| ((w + 1.0) * 512.0).clamp(0.0, 1023.0) as usize;
                cell(w - reach)..cell(w + reach)
            };
            for row in ends(*v) {
                for column in ends(*u) {
                    let place = |k: usize| (k as f64 + 0.5) / 512.0 - 1.0;
                    let away2 = (place(column) - u).powi(2) + (place(row) - v).powi(2);
                    map[row * 1024 + column] *= (1.0 + depth * (-0.5 * away2 / (radius * radius)).exp()) as f32;
                }
            }
        }
        map
    }
}

fn blurred(light: &[f32], width: usize, height: usize, sigma: f64) -> Vec<f32> {
    if sigma <= 0.0 {
        return light.to_vec();
    }
    let reach = (4.0 * sigma).ceil() as isize;
    let bells: Vec<f64> = (-reach..=reach).map(|k| (-0.5 * (k as f64 / sigma).powi(2)).exp()).collect();
    let whole: f64 = bells.iter().sum();
    let kernel: Vec<f32> = bells.iter().map(|bell| (bell / whole) as f32).collect();
    let along = |from: &[f32], step: usize, count: usize, lines: usize, stride: usize| {
        let mut into = vec![0.0f32; from.len()];
        for line in 0..lines {
            for place in 0..count {
                let sum = kernel.iter().zip(-reach..).map(|(weight, by)| {
                    let near = place.saturating_add_signed(by).min(count - 1);
                    weight * from[line * stride + near * step]
                });
                into[line * stride + place * step] = sum.sum();
            }
        }
        into
    };
    let across = along(light, 1, width, height, width);
    along(&across, width, height, width, 1)
}

/// Box and Muller (1958).
fn normal(stream: &mut Stream) -> f64 {
    let (a, b) = (stream.uniform().max(1e-300), stream.uniform());
    (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos()
}
