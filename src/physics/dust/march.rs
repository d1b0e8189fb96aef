//! The light that a ray gathers on its way through dust, front to back.
//!
//! ```text
//! L_b = integral of kappa_b rho S_b exp(-kappa_b c) dt          c(t): the column from the eye
//! ```
//!
//! Columns are exact; the source S is taken at a few nodes of each piece. Pieces end where cells end (or hold some cells, at coarse
//! fineness), and as seen from every star they are equal angles: no longer than a share of the distance from it. So the integral stays
//! right where S grows as 1/r^2, for any distance b at which the ray passes a star and for any law of scattering, however steep.

use super::bricks::Bricks;
use super::camera::Ray;
use super::light::cells::{self, Cell};
use super::model::Scattering;
use super::scene::{MOST_BANDS, Scene};
use super::volume::Volume;

/// How fine the pieces of a ray are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fineness {
    /// Longest piece, voxels. Above 1 a piece holds cells together and has one node, at the column's centre of gravity.
    pub step: f64,
    /// Nodes of a piece in one cell: 1, or Gauss' 2.
    pub nodes: usize,
    /// Largest share of the distance from a star: the angle that a piece is seen under, radians.
    pub angle: f64,
    /// Largest optical depth of a piece, in the band with the most extinction that still sees light.
    pub depth: f64,
}

impl Fineness {
    /// From coarse to fine; each costs about twice as much as the one before.
    pub const LADDER: [Fineness; 6] = [
        Fineness { step: 4.0, nodes: 1, angle: 0.6, depth: 0.6 },
        Fineness { step: 2.0, nodes: 1, angle: 0.4, depth: 0.4 },
        Fineness { step: 1.0, nodes: 1, angle: 0.25, depth: 0.25 },
        Fineness { step: 1.0, nodes: 2, angle: 0.35, depth: 0.5 },
        Fineness { step: 0.5, nodes: 2, angle: 0.2, depth: 0.25 },
        Fineness { step: 0.25, nodes: 2, angle: 0.1, depth: 0.12 },
    ];

    /// With a longest piece of so many voxels, the rest as the ladder has it for such a step.
    #[must_use]
    pub fn of_step(step: f64) -> Fineness {
        let near = Fineness::LADDER.into_iter().find(|rung| rung.step <= step);
        Fineness { step, ..near.unwrap_or(Fineness::LADDER[5]) }
    }

    /// Twice as fine, two nodes a piece.
    #[must_use]
    pub fn finer(self) -> Fineness {
        Fineness { step: 0.5 * self.step.min(1.0), nodes: 2, angle: self.angle / 2.0, depth: self.depth / 2.0 }
    }
}

/// When a ray has seen enough: what is still to come is bounded by a share of what it has, or of a floor.
#[derive(Debug, Clone, PartialEq)]
pub struct Enough {
    /// The share.
    pub share: f64,
    /// Radiance in each band below which nothing is seen.
    pub floor: Vec<f64>,
}

/// Light made in the dust itself, for each unit of length: a volume in the same box, and a radiance per unit of length in each band.
#[derive(Debug, Clone, Copy)]
pub struct Emission<'a> {
    /// How much, relative.
    pub volume: &'a Volume,
    /// Times this, band by band.
    pub bands: &'a [f64],
}

/// What a ray goes through.
#[derive(Clone, Copy)]
pub struct March<'a> {
    /// The dust.
    pub volume: &'a Volume,
    /// Its properties, and the stars.
    pub scene: &'a Scene,
    /// The light in it.
    pub model: &'a dyn Scattering,
    /// Light of its own.
    pub emission: Option<Emission<'a>>,
    /// The most density anywhere: how fast its shadows can deepen along a ray.
    pub densest: f64,
    /// How fine.
    pub fineness: Fineness,
    /// When to end early; never, if nothing is said.
    pub enough: Option<&'a Enough>,
    /// Where there is no dust at all, so that it can be passed over; nothing is, if nothing is said.
    pub bricks: Option<&'a Bricks>,
}

/// What a ray has gathered.
#[derive(Debug, Clone, PartialEq)]
pub struct Gathered {
    /// Radiance in each band.
    pub radiance: [f64; MOST_BANDS],
    /// The column of dust on the whole way: exp(-kappa times it) of what is behind comes through.
    pub column: f64,
    /// What it cost.
    pub tally: Tally,
}

/// Counts of what was done and what was left out.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Tally {
    /// Rays.
    pub rays: u64,
    /// Points at which the source was computed.
    pub sources: u64,
    /// Ways through bricks that may hold dust.
    pub ways: u64,
    /// Cells gone through with dust in them.
    pub cells: u64,
    /// Stretches passed over, no dust being in them.
    pub empty: u64,
    /// Rays that ended early.
    pub ended: u64,
}

impl std::ops::AddAssign for Tally {
    fn add_assign(&mut self, other: Tally) {
        self.rays += other.rays;
        self.sources += other.sources;
        self.ways += other.ways;
        self.cells += other.cells;
        self.empty += other.empty;
        self.ended += other.ended;
    }
}

/// Optical depth after which a ray that has ended goes on no more even for what is behind: 1e-7 comes through.
const OPAQUE: f64 = 16.0;
/// Depth, in the band with the least extinction that still sees light, between two looks at whether it is enough.
const BETWEEN_LOOKS: f64 = 0.5;
/// Gauss' two nodes in 0 to 1.
const GAUSS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];

impl March<'_> {
    /// Follows a ray from a distance (the near plane) on.
    #[must_use]
    pub fn gather(&self, ray: &Ray, near: f64) -> Gathered {
        let mut walker = Walker::new(self, ray, near);
        match self.bricks.filter(|_| self.emission.is_none()) {
            None => walker.walk(near, f64::INFINITY),
            Some(bricks) => {
                // Neighbouring stretches with dust are one way.
                let mut way: Option<(f64, f64)> = None;
                for stretch in bricks.along(ray, near, f64::INFINITY) {
                    if stretch.range.most > 0.0 {
                        way = Some((way.map_or(stretch.from, |(from, _)| from), stretch.to));
                    } else {
                        walker.tally.empty += 1;
                        if let Some((from, to)) = way.take() {
                            walker.walk(from, to);
                        }
                    }
                }
                if let Some((from, to)) = way {
                    walker.walk(from, to);
                }
            }
        }
        let Walker { radiance, column, mut tally, .. } = walker;
        tally.rays = 1;
        Gathered { radiance, column, tally }
    }
}

/// A ray on its way.
struct Walker<'a> {
    march: &'a March<'a>,
    ray: &'a Ray,
    bands: usize,
    /// Closest approach of each star: distance along the ray and from it.
    stars: [(f64, f64); super::scene::MOST_STARS],
    voxel: f64,
    end: f64,
    radiance: [f64; MOST_BANDS],
    /// Up to the piece.
    column: f64,
    /// The piece: where it begins, how long it may be, its column so far and the moment of that about its beginning, where it ends.
    from: f64,
    allowed: f64,
    piece: f64,
    moment: f64,
    to: f64,
    /// The most extinction of a band that still sees light.
    steepest: f64,
    next_look: f64,
    /// Nothing more is gathered; the column may go on.
    ended: bool,
    /// Nothing comes through from behind either.
    over: bool,
    tally: Tally,
}

impl<'a> Walker<'a> {
    fn new(march: &'a March<'a>, ray: &'a Ray, near: f64) -> Walker<'a> {
        let mut stars = [(0.0, 0.0); super::scene::MOST_STARS];
        let least = 1e-6 * march.volume.voxel().min_element();
        for (slot, star) in stars.iter_mut().zip(march.scene.stars()) {
            let way = star.position - ray.origin;
            let along = way.dot(ray.direction);
            *slot = (along, (way - ray.direction * along).length().max(least));
        }
        let extinction = &march.scene.dust().extinction;
        Walker {
            march,
            ray,
            bands: extinction.len(),
            stars,
            voxel: march.volume.voxel().min_element(),
            end: cells::inside(march.volume, ray, near, f64::INFINITY).map_or(near, |(_, far)| far),
            radiance: [0.0; MOST_BANDS],
            column: 0.0,
            from: f64::NAN,
            allowed: 0.0,
            piece: 0.0,
            moment: 0.0,
            to: 0.0,
            steepest: extinction.iter().copied().fold(0.0, f64::max),
            next_look: 0.0,
            ended: false,
            over: false,
            tally: Tally::default(),
        }
    }

    /// Goes on between two distances.
    fn walk(&mut self, from: f64, to: f64) {
        if self.over {
            return;
        }
        self.tally.ways += 1;
        let (volume, ray) = (self.march.volume, self.ray);
        cells::walk(volume, ray, from, to, |cell| {
            self.over = !self.cell(cell);
            !self.over
        });
        self.flush();
    }

    /// Goes through a cell; false when nothing more is to be seen.
    fn cell(&mut self, cell: &Cell) -> bool {
        if self.ended {
            self.column += cell.column(cell.length());
            return self.gentlest() * self.column < OPAQUE;
        }
        if self.march.bricks.is_some() && self.march.emission.is_none() && cell.is_empty() {
            self.flush();
            return true;
        }
        self.tally.cells += 1;
        let length = cell.length();
        let fine = self.march.fineness;
        let merge = fine.nodes == 1;
        let mut s = 0.0;
        while s < length {
            if self.from.is_nan() {
                self.begin(cell.from + s);
            }
            let depth = self.steepest * cell.density(s).max(cell.density(length));
            let room = (fine.depth - self.steepest * self.piece).max(0.25 * fine.depth) / depth.max(1e-300);
            let mut ds = (self.from + self.allowed - cell.from - s).min(room);
            // A rest that is shorter than a tenth goes with the piece before it.
            if ds.is_nan() || ds >= 0.9 * (length - s) {
                ds = length - s;
            }
            // A piece that is shorter than a distance can be told apart ends the cell.
            if cell.from + s + ds <= cell.from + s {
                ds = length - s;
            }
            if merge {
                self.add(cell, s, ds);
            } else {
                self.gauss(cell, s, ds);
            }
            s += ds;
            if !merge || self.to - self.from >= 0.9 * self.allowed || self.steepest * self.piece >= 0.75 * fine.depth {
                self.flush();
            }
        }
        self.look();
        true
    }

    /// Begins a piece: it may be as long as the step, and from no star look longer than the angle.
    fn begin(&mut self, at: f64) {
        let fine = self.march.fineness;
        // Shadows of dense dust elsewhere change along a ray through thin dust too.
        let shadow = (2.0 * fine.depth / (self.steepest * self.march.densest)).max(self.voxel / 32.0);
        let mut allowed = (fine.step * self.voxel).min(shadow);
        for (along, passes) in self.stars.iter().take(self.march.scene.stars().len()) {
            let distance = (at - along).hypot(*passes);
            // The piece may go towards the star: its far end is what counts, but not less than where the ray passes.
            let nearest = if at < *along { (distance / (1.0 + fine.angle)).max(*passes) } else { distance };
            allowed = allowed.min(fine.angle * nearest);
        }
        (self.from, self.to, self.allowed) = (at, at, allowed);
    }

    /// Adds a part of a cell to the piece.
    fn add(&mut self, cell: &Cell, s: f64, ds: f64) {
        let column = cell.column(s + ds) - cell.column(s);
        // Two nodes hold the moment of a cubic but for its last term.
        let moment: f64 =
            GAUSS.iter().map(|node| cell.density(s + node * ds) * (s + node * ds)).sum::<f64>() * 0.5 * ds;
        self.moment += moment + (cell.from - self.from) * column;
        self.piece += column;
        self.to = cell.from + s + ds;
    }

    /// Ends the piece: one node, at the column's centre of gravity, and the exact share of light that its depth turns.
    fn flush(&mut self) {
        if self.from.is_nan() {
            return;
        }
        let length = self.to - self.from;
        let mut source = [0.0; MOST_BANDS];
        if self.piece > 0.0 {
            let at = self.from + (self.moment / self.piece).clamp(0.0, length);
            let source = &mut source[..self.bands];
            self.march.model.source(self.ray.origin + self.ray.direction * at, -self.ray.direction, source);
            self.tally.sources += 1;
        }
        let emitted = self.emitted(self.from + 0.5 * length) * length;
        for (band, extinction) in self.march.scene.dust().extinction.iter().enumerate() {
            let before = (-extinction * self.column).exp();
            self.radiance[band] += before * -(-extinction * self.piece).exp_m1() * source[band];
            if let Some(emission) = self.march.emission {
                let half_way = (-extinction * 0.5 * self.piece).exp();
                self.radiance[band] += before * half_way * emitted * emission.bands[band];
            }
        }
        self.column += self.piece;
        (self.from, self.piece, self.moment) = (f64::NAN, 0.0, 0.0);
    }

    /// A piece in one cell by Gauss' two nodes.
    fn gauss(&mut self, cell: &Cell, s: f64, ds: f64) {
        let mut source = [0.0; MOST_BANDS];
        let before = cell.column(s);
        for node in GAUSS {
            let at = s + node * ds;
            let density = cell.density(at);
            let emitted = self.emitted(cell.from + at) * 0.5 * ds;
            if density > 0.0 {
                let point = self.ray.origin + self.ray.direction * (cell.from + at);
                self.march.model.source(point, -self.ray.direction, &mut source[..self.bands]);
                self.tally.sources += 1;
            }
            let column = self.column + cell.column(at) - before;
            for (band, extinction) in self.march.scene.dust().extinction.iter().enumerate() {
                let made = self.march.emission.map_or(0.0, |emission| emitted * emission.bands[band]);
                self.radiance[band] +=
                    (-extinction * column).exp() * (0.5 * ds * extinction * density * source[band] + made);
            }
        }
        self.column += cell.column(s + ds) - before;
        self.from = f64::NAN;
    }

    fn emitted(&self, at: f64) -> f64 {
        self.march.emission.map_or(0.0, |emission| emission.volume.at(self.ray.origin + self.ray.direction * at))
    }

    fn gentlest(&self) -> f64 {
        self.march.scene.dust().extinction.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// Looks whether what is to come can still be seen in any band.
    fn look(&mut self) {
        let Some(enough) = self.march.enough else { return };
        let column = self.column + self.piece;
        if self.gentlest().min(self.steepest) * column < 2.0 && self.steepest * column < 4.0
            || column < self.next_look
            || self.march.emission.is_some()
        {
            return;
        }
        let at = if self.from.is_nan() { self.to } else { self.to.max(self.from) };
        let mut ceiling = [0.0; MOST_BANDS];
        self.march.model.ceiling(self.ray, at.min(self.end), self.end, &mut ceiling[..self.bands]);
        let (mut steepest, mut gentlest) = (0.0f64, f64::INFINITY);
        for (band, extinction) in self.march.scene.dust().extinction.iter().enumerate() {
            // Dust that is infinitely deep would give the source itself; what does not scatter gives nothing.
            let rest = if *extinction == 0.0 { 0.0 } else { (-extinction * column).exp() * ceiling[band] };
            let floor = enough.floor.get(band).copied().unwrap_or(0.0);
            if rest.is_nan() || rest > enough.share * self.radiance[band].max(floor) {
                steepest = steepest.max(*extinction);
                gentlest = gentlest.min(*extinction);
            }
        }
        if steepest == 0.0 {
            self.flush();
            self.ended = true;
            self.tally.ended += 1;
        } else {
            self.steepest = steepest;
            self.next_look = column + BETWEEN_LOOKS / gentlest;
        }
    }
}
