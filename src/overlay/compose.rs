//! What is in the field, as one picture.

use super::canvas::{Area, Disc, Ink, Region, circle, lay_text, line};
use super::globe::{self, Map};
use super::labels::{self, Wanted};
use super::layout::{self, Beside, Line};
use super::marks::{self, Outline};
use super::menu::{Menu, Placed};
use super::photograph::Photograph;
use super::stars::Starlight;
use super::style::{Eye, Mode, Style};
use super::text::{Scribe, Weight};
use super::tone::Lights;
use super::tone::curve::{Curve, as_thrown};
use super::{information, stars};
use crate::picture::Picture;
use crate::sky::catalogue::{Catalogue, FieldObject, FieldStar, Found, Object};
use crate::sky::ephemeris::{Almanac, InView};
use crate::sky::field::FieldOfView;
use crate::sky::project::Projection;
use crate::units::{Angle, SurfaceBrightness};

/// The only colour of text and marks: the red primary.
const RED: [f32; 3] = [1.0, 0.0, 0.0];
/// Most names that are tried.
const MOST_NAMES: usize = 80;
/// Unnamed stars that get their magnitude written, the brightest first.
const MAGNITUDES: usize = 12;

/// What there is to draw.
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    /// Stars and objects in the field.
    pub found: &'a Found,
    /// What the observer looks at; when nothing is given, what stands out most near the middle.
    pub target: Option<&'a Object>,
    /// The observer's photographs.
    pub photographs: &'a [Photograph],
    /// Where names come from.
    pub catalogue: &'a Catalogue,
    /// A frame of an animation, drawn in place of the photographs.
    pub animation: Option<&'a Photograph>,
    /// The menu over it all.
    pub menu: Option<&'a Menu>,
}

/// Composes pictures, and keeps between them what did not change: written words, and photographs laid on the canvas.
#[derive(Default)]
pub struct Composer {
    scribe: Scribe,
    ink: Option<Ink>,
    photographs: Option<Laid>,
    almanac: Almanac,
    maps: Vec<Map>,
    curve: Option<Curve>,
    lights: Option<Lights>,
    credits: Vec<String>,
    discs: globe::Kept,
}

/// Photographs laid on a canvas, and for which view.
struct Laid {
    view: (Projection, Region, Style, f32, Option<SurfaceBrightness>, Vec<String>),
    /// None as long as the view was asked for only once.
    picture: Option<Picture>,
    /// Whose they are and on which terms they are shown, of those that are seen.
    credits: Vec<String>,
}

/// The view in which the sky is drawn: over the object, or beside it.
struct View {
    projection: Projection,
    region: Region,
    beside: Option<Beside>,
}

/// The picture of a scene. To compose many, keep a [`Composer`].
#[must_use]
pub fn compose(scene: &Scene, field: &FieldOfView, eye: &Eye, style: &Style) -> Picture {
    Composer::default().compose(scene, field, eye, style)
}

impl Composer {
    /// Wraps maps on the discs of their bodies from now on.
    #[must_use]
    pub fn with_maps(mut self, maps: Vec<Map>) -> Composer {
        self.maps = maps;
        self.discs = globe::Kept::default();
        self
    }

    /// How bright the last picture's parts were made, and why; nothing when it was black.
    #[must_use]
    pub fn lights(&self) -> Option<&Lights> {
        self.lights.as_ref()
    }

    /// Whose the photographs in the last picture are and on which terms they are shown, the finest first.
    #[must_use]
    pub fn credits(&self) -> &[String] {
        &self.credits
    }

    /// Where the bodies of the solar system are, remembered from frame to frame.
    pub fn almanac(&mut self) -> &mut Almanac {
        &mut self.almanac
    }

    /// The picture of a scene: exactly black while the mount slews, when the position is stale, and in mode off (there the
    /// menu alone is drawn, if one is open).
    #[must_use]
    pub fn compose(&mut self, scene: &Scene, field: &FieldOfView, eye: &Eye, style: &Style) -> Picture {
        let (width, height) = (field.width_px, field.height_px);
        self.lights = None;
        self.credits.clear();
        if !field.may_draw || (style.mode == Mode::Off && scene.menu.is_none()) {
            return Picture::black(width, height);
        }
        let size = (width, height);
        let Some(mut ink) = self.ink.take().filter(|ink| ink.size() == size).or_else(|| Ink::new(width, height)) else {
            return Picture::black(width, height);
        };

        // Pictures and captions by one operator; from here on the style's shares of light are the toned ones.
        let target = scene.target.cloned().or_else(|| standing_out(scene, field));
        let lights = Lights::of(target.as_ref(), &field.instrument, eye, style);
        let stars = lights.picture / style.photograph.max(1e-6);
        let style = &Style { photograph: lights.picture, text: lights.text, marks: lights.marks, ..style.clone() };
        if self.curve.as_ref().is_none_or(|curve| curve.exponent() != lights.exponent) {
            self.curve = Some(Curve::new(lights.exponent));
        }
        self.lights = Some(lights);

        let visible = Region::new(width, height, vec![eyepiece_disc(field)]);
        let em_px = layout::text_px(field, style);
        let menu = scene.menu.and_then(|menu| Placed::find(menu, &mut self.scribe, em_px, size, &visible));
        let mut picture = if style.mode == Mode::Off {
            Picture::black(width, height)
        } else {
            self.sky(&mut ink, scene, target, field, eye, style, stars, &visible, menu.as_ref().map(|menu| menu.area))
        };
        if let Some(menu) = &menu {
            // What is in the holder is always told under the list.
            if !style.information || style.mode == Mode::Off {
                self.eyepieces_line(&mut picture, field, eye, style, &visible);
            }
            menu.draw(&mut picture, &mut ink, style, &visible);
        }
        // The last word on light: what cannot be seen is black, and no number is no light.
        let ceiling = style.ceiling.max(0.0);
        for y in 0..height {
            let (seen, row) = (visible.span(y), picture.row_mut(y));
            for light in row[seen.clone()].as_flattened_mut() {
                *light = (*light * style.gain).max(0.0).min(ceiling);
            }
            row[..seen.start].fill([0.0; 3]);
            row[seen.end..].fill([0.0; 3]);
        }
        self.ink = Some(ink);
        picture
    }

    /// The sky's picture with its words, which leave the menu's place free.
    #[expect(clippy::too_many_arguments, reason = "what is drawn, on what, and how: each is used once")]
    fn sky(
        &mut self,
        ink: &mut Ink,
        scene: &Scene,
        target: Option<Object>,
        field: &FieldOfView,
        eye: &Eye,
        style: &Style,
        stars: f32,
        visible: &Region,
        menu: Option<Area>,
    ) -> Picture {
        let view = view(field, style, target.as_ref(), visible);

        // The sky: photographs or a moving picture, stars, outlines.
        let still = if scene.animation.is_some() { &[] } else { scene.photographs };
        let own = target.as_ref().and_then(|target| target.surface_brightness);
        let (mut picture, mut credits) = self.photographs(still, field, style, own, &view);
        if let Some(frame) = scene.animation
            && frame.draw(&mut picture, &view.region, &view.projection, as_thrown(style, self.curve.as_ref(), 1.0))
        {
            credits.extend(frame.credit_line());
        }
        let photographed = !still.is_empty() || scene.animation.is_some();
        let starlight = Starlight { palette: style.palette, share: stars };
        draw_stars(&mut picture, scene, field, starlight, &view, photographed);
        draw_bodies(&mut picture, scene, style, starlight, &view, &self.maps, self.curve.as_ref(), &mut self.discs);
        let outlines = outlines(scene, &view);
        self.draw_marks(&mut picture, ink, &outlines, target.as_ref(), field, style, &view, visible);

        // The words, each keeping the place of those before it.
        let mut taken: Vec<Area> = menu.into_iter().collect();
        if style.uncertainty && view.beside.is_none() {
            taken.extend(self.uncertainty(&mut picture, field, style, visible));
        }
        taken.extend(self.credit(&mut picture, &credits, field, style, visible));
        self.credits = credits;
        if style.information {
            taken.extend(self.information(&mut picture, target.as_ref(), field, eye, style, visible));
            taken.extend(self.compass(&mut picture, ink, field, style, &view, visible));
        }
        if style.labels {
            self.names(&mut picture, ink, scene, field, style, &view, &outlines, target.as_ref(), taken);
        }
        picture
    }

    /// A picture with the photographs on it (copied from the third time on, if nothing changed), and the credits of those that
    /// are seen. The finer ones lie over the coarser.
    fn photographs(
        &mut self,
        all: &[Photograph],
        field: &FieldOfView,
        style: &Style,
        own: Option<SurfaceBrightness>,
        view: &View,
    ) -> (Picture, Vec<String>) {
        if all.is_empty() {
            return (Picture::black(field.width_px, field.height_px), Vec::new());
        }
        let names = all.iter().map(|photograph| photograph.name.clone()).collect();
        let exponent = self.curve.as_ref().map_or(1.0, Curve::exponent);
        let wanted = (view.projection, view.region.clone(), style.clone(), exponent, own, names);
        let again = self.photographs.as_ref().is_some_and(|laid| laid.view == wanted);
        if let Some(Laid { picture: Some(picture), credits, .. }) = self.photographs.as_ref().filter(|_| again) {
            return (picture.clone(), credits.clone());
        }
        let mut picture = Picture::black(field.width_px, field.height_px);
        let mut credits = Vec::new();
        let mut finest_last: Vec<&Photograph> = all.iter().collect();
        finest_last.sort_by(|a, b| b.plate.scale().to_radians().total_cmp(&a.plate.scale().to_radians()));
        for photograph in finest_last {
            let light = as_thrown(style, self.curve.as_ref(), photograph.gain(own));
            if photograph.draw(&mut picture, &view.region, &view.projection, light) {
                credits.extend(photograph.credit_line());
            }
        }
        credits.reverse();
        credits.dedup();
        // A field that drifts is never the same twice: copying its picture would be for nothing.
        let kept = again.then(|| picture.clone());
        self.photographs = Some(Laid { view: wanted, picture: kept, credits: credits.clone() });
        (picture, credits)
    }

    /// Outlines, the target's marks, the circles of uncertainty, eyepiece and window.
    #[expect(clippy::too_many_arguments, reason = "what is drawn, on what, and how: each is used once")]
    fn draw_marks(
        &mut self,
        picture: &mut Picture,
        ink: &mut Ink,
        outlines: &[(FieldObject, Outline)],
        target: Option<&Object>,
        field: &FieldOfView,
        style: &Style,
        view: &View,
        visible: &Region,
    ) {
        let dim = RED.map(|channel| channel * style.marks);
        let bright = RED.map(|channel| channel * style.text);
        let is_target = |object: &FieldObject| target.is_some_and(|target| target.name == object.name);

        for (_, outline) in outlines.iter().filter(|(object, _)| !is_target(object)) {
            outline.draw(ink, 1.3);
        }
        ink.lay(picture, &view.region, dim);

        let middle = target.and_then(|target| view.projection.pixel(&target.astrometry.position));
        let own = outlines.iter().find(|(object, _)| is_target(object)).map(|(_, outline)| outline);
        if let (Some((x, y)), Some(outline)) = (middle, own) {
            outline.draw(ink, 1.8);
            if outline.minor_radius() > field.height_px as f64 / 2.0 && outline.radius() > 1.1 * outline.minor_radius()
            {
                outline.draw_axis(ink, 34.0, 190.0);
            }
            if outline.minor_radius() < 14.0 {
                marks::reticle(ink, x, y, outline.radius() + 8.0);
            } else {
                marks::reticle(ink, x, y, 14.0);
            }
        } else if let Some((x, y)) = middle {
            marks::reticle(ink, x, y, 14.0);
        }
        ink.lay(picture, &view.region, bright);

        if style.uncertainty && view.beside.is_none() && field.uncertainty.to_radians() > 0.0 {
            let radius = field.projection.pixels(field.uncertainty);
            let disc = Disc { x: field.width_px as f64 / 2.0, y: field.height_px as f64 / 2.0, radius };
            marks::broken_circle(ink, disc, 1.0, (2.0, 7.0));
        }
        let rims = [style.field_circle.then(|| eyepiece_disc(field)), view.beside.map(|beside| beside.window)];
        for disc in rims.into_iter().flatten() {
            if let Some(path) = circle(Disc { radius: disc.radius - 1.0, ..disc }) {
                ink.stroke(&path, 1.2, None);
            }
        }
        ink.lay(picture, visible, dim);
    }

    /// The block on top and the line at the bottom; their boxes.
    fn information(
        &mut self,
        picture: &mut Picture,
        target: Option<&Object>,
        field: &FieldOfView,
        eye: &Eye,
        style: &Style,
        visible: &Region,
    ) -> Vec<Area> {
        let em_px = layout::text_px(field, style);
        let about = |target| information::about(target, field, eye, &style.facts);
        let words = target.map_or_else(|| information::about_nothing(field), about);
        let mut lines: Vec<Line> = layout::block(&mut self.scribe, &words, em_px, field, visible);
        let below = information::eyepiece(field, eye);
        lines.extend(layout::bottom_line(&mut self.scribe, &below, em_px, field, visible));
        let red = RED.map(|channel| channel * style.text);
        for line in &lines {
            lay_text(picture, &line.text, line.left, line.top, red);
        }
        lines.iter().map(Line::area).collect()
    }

    /// Whose the photographs are and on which terms they are shown, above the eyepiece's line, shortened until it can be seen
    /// whole; its box.
    fn credit(
        &mut self,
        picture: &mut Picture,
        credits: &[String],
        field: &FieldOfView,
        style: &Style,
        visible: &Region,
    ) -> Option<Area> {
        let (finest, others) = credits.split_first()?;
        let em_px = (layout::text_px(field, style) * 0.7).max(13.0);
        let lowest = field.height_px as f64 - 3.2 * f64::from(layout::text_px(field, style));
        let more = if others.is_empty() { String::new() } else { format!(" + {} more", others.len()) };
        let line = [90, 60, 40, 28, 20].into_iter().find_map(|most| {
            let words = format!("photograph: {}{more}", shortened(finest, most));
            let text = self.scribe.write(&words, Weight::Bold, em_px);
            let line = Line::centred(text, field.width_px as f64 / 2.0, lowest);
            visible.contains_box(&line.area()).then_some(line)
        })?;
        lay_text(picture, &line.text, line.left, line.top, RED.map(|channel| channel * style.marks));
        Some(line.area())
    }

    /// The line of the eyepiece in use, alone.
    fn eyepieces_line(
        &mut self,
        picture: &mut Picture,
        field: &FieldOfView,
        eye: &Eye,
        style: &Style,
        visible: &Region,
    ) {
        let words = information::eyepiece(field, eye);
        let em_px = layout::text_px(field, style);
        if let Some(line) = layout::bottom_line(&mut self.scribe, &words, em_px, field, visible) {
            lay_text(picture, &line.text, line.left, line.top, RED.map(|channel| channel * style.text));
        }
    }

    /// How uncertain the position is, written under its circle; the box.
    fn uncertainty(
        &mut self,
        picture: &mut Picture,
        field: &FieldOfView,
        style: &Style,
        visible: &Region,
    ) -> Option<Area> {
        let arcmin = field.uncertainty.to_arcminutes();
        let words = if arcmin < 0.95 {
            format!("±{:.0}″", arcmin * 60.0)
        } else {
            format!("±{arcmin:.1}′").replace(".0′", "′")
        };
        let em_px = (layout::text_px(field, style) * 0.8).max(13.0);
        let text = self.scribe.write(&words, Weight::Bold, em_px);
        let below = field.height_px as f64 / 2.0 + field.projection.pixels(field.uncertainty);
        let line = Line::centred(text, field.width_px as f64 / 2.0, below);
        let seen = arcmin > 0.0 && visible.contains_box(&line.area());
        seen.then(|| {
            lay_text(picture, &line.text, line.left, line.top, RED.map(|channel| channel * style.marks));
            line.area()
        })
    }

    /// North and east at the lower left, a bar of the sky's scale at the lower right; their boxes.
    fn compass(
        &mut self,
        picture: &mut Picture,
        ink: &mut Ink,
        field: &FieldOfView,
        style: &Style,
        view: &View,
        visible: &Region,
    ) -> Vec<Area> {
        let em_px = (layout::text_px(field, style) * 0.85).max(13.0);
        let (middle_x, middle_y) = (field.width_px as f64 / 2.0, field.height_px as f64 / 2.0);
        let length = 30.0;
        // From the lower corner towards the middle, until it can be seen.
        let seen = |side: f64| {
            (0..100).map(|step| 1.0 - f64::from(step) / 100.0).find_map(|part| {
                let (x, y) = (middle_x + side * (middle_x - 62.0) * part, middle_y + (middle_y - 90.0) * part);
                visible.contains_box(&Area::about(x, y, 52.0, 52.0)).then_some((x, y))
            })
        };
        let (Some(left), Some(right)) = (seen(-1.0), seen(1.0)) else { return Vec::new() };

        let letters = marks::compass(ink, &view.projection, left.0, left.1, length);
        let (bar_left, words) = marks::scale_bar(ink, &view.projection, right.0 + 45.0, right.1 + 40.0, 130.0);
        let red = RED.map(|channel| channel * style.text * 0.75);
        ink.lay(picture, visible, red);
        for (letter, (x, y)) in ["N", "E"].into_iter().zip(letters) {
            let text = self.scribe.write(letter, Weight::Bold, em_px);
            let top = y - text.height as f64 / 2.0;
            let line = Line::centred(text, x, top);
            lay_text(picture, &line.text, line.left, line.top, red);
        }
        let text = self.scribe.write(&words, Weight::Bold, em_px);
        let bar_middle = (bar_left + right.0 + 45.0) / 2.0;
        let top = right.1 + 36.0 - text.height as f64;
        let line = Line::centred(text, bar_middle, top);
        lay_text(picture, &line.text, line.left, line.top, red);
        let bar = Area { left: bar_left - 6.0, top: line.area().top, right: right.0 + 51.0, bottom: right.1 + 48.0 };
        vec![Area::about(left.0, left.1, length + 22.0, length + 22.0), bar]
    }

    /// Names of objects and stars, the most important first.
    #[expect(clippy::too_many_arguments, reason = "what is named, on what, and how: each is used once")]
    fn names(
        &mut self,
        picture: &mut Picture,
        ink: &mut Ink,
        scene: &Scene,
        field: &FieldOfView,
        style: &Style,
        view: &View,
        outlines: &[(FieldObject, Outline)],
        target: Option<&Object>,
        mut taken: Vec<Area>,
    ) {
        let em_px = (layout::text_px(field, style) * 0.85).max(13.0);
        let named = names(scene, field, view, outlines, target);
        // Nothing may be written over a disc, or over the target's middle.
        for seen in &scene.found.bodies {
            let radius = view.projection.pixels(seen.globe.radius);
            if let Some((x, y)) = view.projection.pixel(&seen.position).filter(|_| radius < 150.0) {
                taken.push(Area::about(x, y, radius, radius));
            }
        }
        if let Some((x, y)) = target.and_then(|target| view.projection.pixel(&target.astrometry.position)) {
            taken.push(Area::about(x, y, 28.0, 28.0));
        }

        let written: Vec<_> = named.iter().map(|name| self.scribe.write(&name.text, Weight::Bold, em_px)).collect();
        let wanted: Vec<Wanted> = named
            .iter()
            .zip(&written)
            .map(|(name, text)| Wanted {
                x: name.x,
                y: name.y,
                radius: name.radius,
                width: text.width as f64 - 2.0,
                height: text.height as f64 - 6.0,
            })
            .collect();
        let placed = labels::place(&wanted, &view.region, &mut taken);
        for leader in placed.iter().filter_map(|name| name.leader) {
            if let Some(path) = line(leader.0, leader.1) {
                ink.stroke(&path, 1.0, None);
            }
        }
        ink.lay(picture, &view.region, RED.map(|channel| channel * style.marks));
        for name in placed {
            let (left, top) = (name.area.left.round() as i64 - 1, name.area.top.round() as i64 - 3);
            let light = if named[name.index].faint { style.marks } else { (style.text + style.marks) / 2.0 };
            lay_text(picture, &written[name.index], left, top, RED.map(|channel| channel * light));
        }
    }
}

/// A text of at most so many characters; what is left out of its middle is an ellipsis, since terms stand at its end.
fn shortened(text: &str, most: usize) -> String {
    let length = text.chars().count();
    if length <= most {
        return text.to_owned();
    }
    let tail = most / 2;
    let head: String = text.chars().take(most - tail - 1).collect();
    let tail: String = text.chars().skip(length - tail).collect();
    format!("{}…{}", head.trim_end(), tail.trim_start())
}

/// A name and what it belongs to.
struct Named {
    text: String,
    x: f64,
    y: f64,
    radius: f64,
    /// Smaller is more important.
    rank: f64,
    /// Whether it is a magnitude only.
    faint: bool,
}

/// What is to be named, the most important first: the target, then by brightness.
fn names(
    scene: &Scene,
    field: &FieldOfView,
    view: &View,
    outlines: &[(FieldObject, Outline)],
    target: Option<&Object>,
) -> Vec<Named> {
    let mut named: Vec<Named> = Vec::new();
    for (object, outline) in outlines {
        let is_target = target.is_some_and(|target| target.name == object.name);
        // An outline that leaves the view is named at its middle.
        let radius = if outline.radius() < 150.0 { outline.radius() } else { 30.0 };
        let magnitude = object.magnitude.map_or(16.0, |magnitude| magnitude.0);
        let rank = if is_target { f64::MIN } else { magnitude - 6.0 };
        named.push(Named { text: object.name.into(), x: outline.x, y: outline.y, radius, rank, faint: false });
    }
    // In a picture made much smaller the numbers would hide the stars.
    let crowded = view.beside.is_some_and(|beside| beside.factor < 0.5);
    let mut unnamed = if crowded { MAGNITUDES } else { 0 };
    let mut by_light: Vec<&FieldStar> = scene.found.stars.iter().collect();
    by_light.sort_by(|a, b| a.v_mag.total_cmp(&b.v_mag));
    for star in by_light.into_iter().take(4 * MOST_NAMES) {
        let place = stars::place(star, field.years);
        let Some((x, y)) = view.projection.pixel(&place) else { continue };
        if !view.region.contains(x, y) || behind(scene, &place) {
            continue;
        }
        let radius = f64::from(stars::sigma_px(star.v_mag) * 1.6);
        let v_mag = f64::from(star.v_mag);
        match scene.catalogue.star_name(star.id) {
            Some(text) => named.push(Named { text, x, y, radius, rank: v_mag - 3.0, faint: false }),
            None if unnamed < MAGNITUDES => {
                unnamed += 1;
                named.push(Named { text: format!("{v_mag:.1}"), x, y, radius, rank: v_mag + 8.0, faint: true });
            }
            None => {}
        }
    }
    for seen in &scene.found.bodies {
        name_body(&mut named, seen, view);
    }
    named.retain(|name| view.region.contains(name.x, name.y));
    named.sort_by(|a, b| a.rank.total_cmp(&b.rank));
    named.truncate(MOST_NAMES);
    named
}

/// A body's name and those of its moons, also of a moon that is in the planet's shadow; one behind the planet has none.
fn name_body(named: &mut Vec<Named>, seen: &InView, view: &View) {
    if let Some((x, y)) = view.projection.pixel(&seen.position) {
        let rings = if seen.body == crate::sky::ephemeris::Body::Saturn { 2.3 } else { 1.0 };
        let radius = view.projection.pixels(seen.globe.radius) * rings;
        // A disc that fills the view needs no name.
        if radius < 200.0 {
            named.push(Named { text: seen.body.name().into(), x, y, radius, rank: -1e6, faint: false });
        }
    }
    for (moon, position) in seen.moons.iter().filter(|(moon, _)| !moon.hidden) {
        let Some((x, y)) = view.projection.pixel(position) else { continue };
        let radius = f64::from(stars::sigma_px(moon.magnitude.0 as f32) * 1.6);
        let text = if moon.eclipsed { format!("{} (in shadow)", moon.name) } else { moon.name.into() };
        named.push(Named { text, x, y, radius, rank: moon.magnitude.0 - 30.0, faint: moon.eclipsed });
    }
}

/// How far from the middle of the field a catalogue must be asked, so that nothing is missing in the picture: in mode beside a
/// picture made smaller shows more sky than the eyepiece.
#[must_use]
pub fn reach(field: &FieldOfView, style: &Style, target: Option<&Object>) -> Angle {
    let visible = Region::new(field.width_px, field.height_px, vec![eyepiece_disc(field)]);
    match view(field, style, target, &visible).beside {
        Some(beside) => {
            field.radius().max(field.projection.scale() * (beside.window.radius / beside.factor + field.circle_px()))
        }
        None => field.radius(),
    }
}

/// The eyepiece's circle on the canvas.
fn eyepiece_disc(field: &FieldOfView) -> Disc {
    let (x, y) = field.projection.middle();
    Disc { x, y, radius: field.circle_px() }
}

/// Over the object, or beside it.
fn view(field: &FieldOfView, style: &Style, target: Option<&Object>, visible: &Region) -> View {
    let over = View { projection: field.projection, region: visible.clone(), beside: None };
    if style.mode != Mode::Beside {
        return over;
    }
    let middle = (field.width_px as f64 / 2.0, field.height_px as f64 / 2.0);
    let (x, y) = target
        .and_then(|target| field.projection.pixel(&target.astrometry.position))
        .filter(|(x, y)| visible.contains(*x, *y))
        .unwrap_or(middle);
    let radius = target
        .and_then(|target| target.axes_arcmin)
        .map_or(0.0, |(major, _)| field.projection.pixels(Angle::arcminutes(major)) / 2.0);
    let beside = layout::beside(field, x, y, radius);
    let region = Region::new(field.width_px, field.height_px, vec![eyepiece_disc(field), beside.window]);
    View { projection: beside.projection, region, beside: Some(beside) }
}

/// Outlines of all objects, points left out.
fn outlines(scene: &Scene, view: &View) -> Vec<(FieldObject, Outline)> {
    let all = scene.found.objects.iter().chain(&scene.found.reaching_in);
    all.filter(|object| !information::is_point(object.kind))
        .filter_map(|object| Some((*object, Outline::of(object, &view.projection)?)))
        .collect()
}

/// Draws discs, and the moons that are neither behind them nor in their shadow.
#[expect(clippy::too_many_arguments, reason = "what is drawn, on what, and how: each is used once")]
fn draw_bodies(
    picture: &mut Picture,
    scene: &Scene,
    style: &Style,
    starlight: Starlight,
    view: &View,
    maps: &[Map],
    curve: Option<&Curve>,
    discs: &mut globe::Kept,
) {
    let light = as_thrown(style, curve, 1.0);
    let exponent = curve.map_or(1.0, Curve::exponent);
    let key = [style.palette as u32, style.photograph.to_bits(), exponent.to_bits()];
    for seen in &scene.found.bodies {
        discs.draw(picture, &view.region, &view.projection, seen, maps, key, &light);
        for (moon, position) in seen.moons.iter().filter(|(moon, _)| !moon.hidden && !moon.eclipsed) {
            let Some((x, y)) = view.projection.pixel(position).filter(|(x, y)| view.region.contains(*x, *y)) else {
                continue;
            };
            stars::point(picture, &view.region, x, y, moon.magnitude.0 as f32, Some(0.8), starlight);
        }
    }
}

/// Whether a place on the sky is behind a disc.
fn behind(scene: &Scene, position: &crate::sky::coords::Equatorial<crate::sky::coords::J2000>) -> bool {
    scene.found.bodies.iter().any(|seen| seen.position.separation(position) < seen.globe.radius * seen.globe.polar)
}

/// Draws the stars; where a photograph already shows them they are left out.
fn draw_stars(
    picture: &mut Picture,
    scene: &Scene,
    field: &FieldOfView,
    starlight: Starlight,
    view: &View,
    photographed: bool,
) {
    for star in &scene.found.stars {
        let place = stars::place(star, field.years);
        let Some((x, y)) = view.projection.pixel(&place) else { continue };
        if !view.region.contains(x, y) || behind(scene, &place) {
            continue;
        }
        let shown = photographed && picture.row(y as usize)[x as usize].iter().sum::<f32>() > 0.02;
        if !shown {
            stars::draw(picture, &view.region, x, y, star, starlight);
        }
    }
}

/// What stands out most near the middle: the brightest deep-sky object, else the brightest star that has a name.
fn standing_out(scene: &Scene, field: &FieldOfView) -> Option<Object> {
    let near = field.radius() * 0.6;
    let objects = scene.found.objects.iter().filter(|object| object.separation <= near);
    let brightness = |object: &&FieldObject| object.magnitude.map_or(99.0, |magnitude| magnitude.0);
    let object = objects.min_by(|a, b| brightness(a).total_cmp(&brightness(b)));
    if let Some(object) = object.and_then(|object| scene.catalogue.object(object.index)) {
        return Some(object);
    }
    let stars = scene.found.stars.iter().filter(|star| star.separation <= near);
    let named = stars.filter(|star| scene.catalogue.star_name(star.id).is_some());
    let brightest = named.min_by(|a, b| a.v_mag.total_cmp(&b.v_mag))?;
    scene.catalogue.star(brightest.id)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sky::coords::Equatorial;
    use crate::sky::optics::Instrument;

    fn ring() -> Object {
        Catalogue::embedded().search("M57").unwrap()
    }

    fn field_at(object: &Object, eyepiece_mm: f64) -> FieldOfView {
        let instrument = Instrument::default().with_eyepiece(eyepiece_mm);
        FieldOfView::towards(&object.astrometry.position, Angle::degrees(30.0), &instrument)
    }

    fn composed(field: &FieldOfView, style: &Style) -> Picture {
        let catalogue = Catalogue::embedded();
        let target = ring();
        let found =
            catalogue.within(&field.centre(), reach(field, style, Some(&target)), crate::units::Magnitude(11.0));
        let scene =
            Scene { found: &found, target: Some(&target), photographs: &[], catalogue, animation: None, menu: None };
        compose(&scene, field, &Eye::default(), style)
    }

    #[test]
    fn while_it_slews_with_a_stale_position_or_switched_off_the_picture_is_exactly_black() {
        let field = field_at(&ring(), 24.0);
        assert!(!composed(&field, &Style::default()).is_black());
        assert!(composed(&FieldOfView { may_draw: false, ..field.clone() }, &Style::default()).is_black());
        assert!(composed(&field, &Style { mode: Mode::Off, ..Style::default() }).is_black());
        assert!(composed(&field, &Style { gain: 0.0, ..Style::default() }).is_black());
    }

    #[test]
    fn no_pixel_is_brighter_than_the_ceiling_and_the_red_palette_is_red_only() {
        let style = Style { ceiling: 0.2, palette: super::super::Palette::Red, ..Style::default() };
        for mode in [Mode::Over, Mode::Beside] {
            let picture = composed(&field_at(&ring(), 24.0), &Style { mode, ..style.clone() });
            assert!(picture.pixels().iter().all(|[r, g, b]| *r <= 0.2 && *g == 0.0 && *b == 0.0));
        }
    }

    /// Section 8.6 of the thesis. Without stars and pictures all that is drawn is captions, the menu among them.
    #[test]
    fn no_caption_is_brighter_than_the_pictures_limit_whatever_is_asked() {
        let target = ring();
        let field = field_at(&target, 24.0);
        let line =
            |n: usize| super::super::menu::Entry { label: format!("line {n}"), value: "on".into(), chosen: n == 1 };
        let menu = Menu { title: "menu".into(), lines: (0..5).map(line).collect(), bar: Some(2), hint: "?: on".into() };
        let found = Found {
            stars: Vec::new(),
            ..Catalogue::embedded().within(&field.centre(), field.radius(), crate::units::Magnitude(20.0))
        };
        let scene = Scene {
            found: &found,
            target: Some(&target),
            photographs: &[],
            catalogue: Catalogue::embedded(),
            animation: None,
            menu: Some(&menu),
        };
        for (picture, captions, photograph) in
            [(None, None, 0.6), (None, Some(15.0), 0.3), (Some(6.0), Some(9.0), 0.6), (Some(3.0), None, 0.6)]
        {
            for method in crate::eye::tone::Method::ALL {
                let tone = super::super::tone::Toning {
                    method,
                    picture_over_object_mag: picture,
                    captions_over_object_mag: captions,
                };
                let style = Style { tone, photograph, ..Style::default() };
                let mut composer = Composer::default();
                let shown = composer.compose(&scene, &field, &Eye::default(), &style);
                let limit = composer.lights().unwrap().picture;
                let brightest = shown.pixels().iter().flatten().copied().fold(0.0, f32::max);
                assert!(
                    brightest <= limit * 1.0001 && brightest > 0.0,
                    "{method} {picture:?} {captions:?}: {brightest} over {limit}"
                );
            }
        }
    }

    #[test]
    fn nothing_is_drawn_outside_the_eyepieces_circle() {
        let field = field_at(&ring(), 10.0);
        let picture = composed(&field, &Style::default());
        let radius = field.circle_px();
        for (index, pixel) in picture.pixels().iter().enumerate() {
            let (x, y) = ((index % 1024) as f64 + 0.5 - 512.0, (index / 1024) as f64 + 0.5 - 384.0);
            assert!(x.hypot(y) <= radius + 1.0 || *pixel == [0.0; 3], "{x} {y}");
        }
    }

    #[test]
    fn the_middle_of_the_target_stays_free() {
        let picture = composed(&field_at(&ring(), 24.0), &Style::default());
        for y in 374..394 {
            assert!(picture.row(y)[502..522].iter().all(|pixel| *pixel == [0.0; 3]), "row {y}");
        }
    }

    #[test]
    fn the_ring_nebulas_outline_has_its_true_size() {
        let target = ring();
        let field = field_at(&target, 24.0);
        let style = Style { labels: false, information: false, uncertainty: false, ..Style::default() };
        let picture = composed(&field, &style);
        let (major, _) = target.axes_arcmin.unwrap();
        // Along the canvas' row through the middle the rim is at half an axis: 1.27 arcminutes are 33.7 pixels.
        let radius = field.projection.pixels(Angle::arcminutes(major)) / 2.0;
        let row = picture.row(384);
        let lit: Vec<usize> = (545..600).filter(|&x| row[x][0] > 0.3).collect();
        assert!(lit.iter().any(|&x| (x as f64 + 0.5 - 512.0 - radius).abs() <= 1.0), "{radius}: {lit:?}");
    }

    #[test]
    fn an_empty_field_names_its_position() {
        let position = Equatorial::new(Angle::degrees(185.0), Angle::degrees(30.0));
        let field = FieldOfView::towards(&position, Angle::ZERO, &Instrument::default());
        let scene = Scene {
            catalogue: Catalogue::embedded(),
            found: &Found::default(),
            target: None,
            photographs: &[],
            animation: None,
            menu: None,
        };
        let picture = compose(&scene, &field, &Eye::default(), &Style::default());
        assert!(picture.row(30).iter().any(|pixel| pixel[0] > 0.3));
    }
}
