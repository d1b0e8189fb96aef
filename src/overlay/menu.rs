//! The menu in the eyepiece: a list on the right side as figure 8.10 of the thesis has it, red on black, inside the circle
//! that is seen. A plain value: what it says and which line is under the bar; who opens it and when it goes away is the
//! session's.

use std::rc::Rc;

use tiny_skia::{Path, PathBuilder};

use super::canvas::{Area, Ink, Region, lay_text, line};
use super::layout::Line;
use super::style::Style;
use super::text::{Scribe, Weight, Written};
use crate::picture::Picture;

/// Smallest text, in pixels an em.
const SMALLEST_PX: f32 = 13.0;
/// From the frame to what is written, in pixels.
const PADDING: f64 = 10.0;
/// Between a line's label and its value.
const GAP: f64 = 18.0;
/// Room for the mark before a line, in ems.
const MARK_EM: f64 = 0.95;
/// From a line to the next, in ems.
const PITCH_EM: f64 = 1.5;
/// From the middle of the field to the list: the object stays free when there is any room for that.
const CLEARANCE: f64 = 40.0;
/// Fewest lines that are still a list.
const FEWEST: usize = 3;

/// A list drawn into the eyepiece.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Menu {
    /// What is chosen here: `eyepiece`.
    pub title: String,
    /// Its lines.
    pub lines: Vec<Entry>,
    /// The line under the bar.
    pub bar: Option<usize>,
    /// What the keys do, in small letters below; or nothing.
    pub hint: String,
}

/// A line of the list.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Entry {
    /// On the left.
    pub label: String,
    /// On the right, or nothing.
    pub value: String,
    /// Whether a dot says that this one is in use.
    pub chosen: bool,
}

/// A menu laid out on the canvas.
pub(super) struct Placed {
    /// Its frame.
    pub(super) area: Area,
    em: f64,
    title: Rc<Written>,
    rows: Vec<Row>,
    hint: Option<Rc<Written>>,
    /// Whether there are lines above and below those that are shown.
    more: (bool, bool),
    marked: bool,
}

struct Row {
    label: Rc<Written>,
    value: Rc<Written>,
    chosen: bool,
    under_bar: bool,
}

/// How much of the menu is attempted.
#[derive(Clone, Copy)]
struct Attempt {
    em_px: f32,
    rows: usize,
    hint: bool,
    clearance: f64,
}

impl Placed {
    /// Finds a place on the right side, about half way up, where all of the menu can be seen: whole and in the overlay's
    /// text size if possible, else smaller, else with fewer lines about the bar, else over the middle. `None` when not even
    /// that fits.
    pub(super) fn find(
        menu: &Menu,
        scribe: &mut Scribe,
        em_px: f32,
        size: (usize, usize),
        region: &Region,
    ) -> Option<Placed> {
        let sizes = [em_px, (em_px + SMALLEST_PX) / 2.0, SMALLEST_PX];
        let all = menu.lines.len();
        let fewest = FEWEST.min(all);
        let attempts = [CLEARANCE, f64::NEG_INFINITY].into_iter().flat_map(|clearance| {
            (fewest..=all).rev().flat_map(move |rows| {
                [true, false]
                    .into_iter()
                    .flat_map(move |hint| sizes.into_iter().map(move |em_px| Attempt { em_px, rows, hint, clearance }))
            })
        });
        for attempt in attempts {
            let written = Placed::written(menu, scribe, attempt);
            if let Some(area) = right_side(written.size(), size, attempt.clearance, region) {
                return Some(Placed { area, ..written });
            }
        }
        None
    }

    fn written(menu: &Menu, scribe: &mut Scribe, attempt: Attempt) -> Placed {
        let Attempt { em_px, rows, .. } = attempt;
        let bar = menu.bar.unwrap_or(0).min(menu.lines.len().saturating_sub(1));
        let first = bar.saturating_sub(rows / 2).min(menu.lines.len() - rows);
        let shown = menu.lines.iter().enumerate().skip(first).take(rows);
        let rows: Vec<Row> = shown
            .map(|(index, entry)| Row {
                label: scribe.write(&entry.label, Weight::Bold, em_px),
                value: scribe.write(&entry.value, Weight::Bold, em_px),
                chosen: entry.chosen,
                under_bar: menu.bar == Some(index),
            })
            .collect();
        Placed {
            area: Area::about(0.0, 0.0, 0.0, 0.0),
            em: f64::from(em_px),
            title: scribe.write(&menu.title, Weight::Bold, em_px),
            more: (first > 0, first + rows.len() < menu.lines.len()),
            marked: menu.lines.iter().any(|entry| entry.chosen),
            rows,
            hint: (attempt.hint && !menu.hint.is_empty())
                .then(|| scribe.write(&menu.hint, Weight::Bold, (em_px * 0.8).max(12.0))),
        }
    }

    fn mark_width(&self) -> f64 {
        if self.marked { MARK_EM * self.em } else { 0.0 }
    }

    /// Width and height of the frame.
    fn size(&self) -> (f64, f64) {
        let row = |row: &Row| {
            let value = row.value.ink_width();
            self.mark_width() + row.label.ink_width() + if value > 0.0 { GAP + value } else { 0.0 }
        };
        let widest = self.rows.iter().map(row).fold(self.title.ink_width(), f64::max);
        let widest = self.hint.iter().map(|hint| hint.ink_width()).fold(widest, f64::max);
        let hint = if self.hint.is_some() { 1.3 * self.em } else { 0.0 };
        let height = (1.0 + self.rows.len() as f64) * PITCH_EM * self.em + hint + 0.5 * self.em;
        (widest + 2.0 * PADDING, height + PADDING)
    }

    /// Draws it: a black card with a red frame, so that nothing of the sky's picture is read through the words.
    pub(super) fn draw(&self, picture: &mut Picture, ink: &mut Ink, style: &Style, region: &Region) {
        // No caption is brighter than a picture's white.
        let light = |share: f32| [(style.text * share).min(style.photograph), 0.0, 0.0];
        let mut lay = |path: Option<Path>, stroke: Option<f32>, colour: [f32; 3]| {
            if let Some(path) = path {
                match stroke {
                    Some(width) => ink.stroke(&path, width, None),
                    None => ink.fill(&path),
                }
                ink.lay(picture, region, colour);
            }
        };
        let Area { left, top, right, bottom } = self.area;
        let (inner_left, inner_right) = (left + PADDING, right - PADDING);
        let pitch = PITCH_EM * self.em;
        let first = top + PADDING / 2.0;

        lay(rounded(&self.area, 7.0), None, [0.0; 3]);
        lay(rounded(&self.area, 7.0), Some(1.2), light(0.45));
        let rule = first + pitch;
        lay(line((inner_left, rule), (inner_right, rule)), Some(1.0), light(0.35));
        let middle_of = |index: usize| first + pitch * (index as f64 + 1.5) + 0.25 * self.em;
        for (index, row) in self.rows.iter().enumerate() {
            let middle = middle_of(index);
            if row.under_bar {
                let bar = Area {
                    left: left + 4.0,
                    right: right - 4.0,
                    top: middle - 0.46 * pitch,
                    bottom: middle + 0.46 * pitch,
                };
                lay(rounded(&bar, 4.0), None, light(0.16));
                lay(rounded(&bar, 4.0), Some(1.2), light(0.9));
            }
            if row.chosen {
                let dot = PathBuilder::from_circle(
                    (inner_left + 0.3 * self.em) as f32,
                    middle as f32,
                    (0.2 * self.em) as f32,
                );
                lay(dot, None, light(1.0));
            }
        }
        let arrow_x = inner_right - 0.35 * self.em;
        if self.more.0 {
            lay(triangle(arrow_x, first + 0.5 * pitch, -0.28 * self.em), None, light(0.8));
        }
        if self.more.1 {
            lay(triangle(arrow_x - 1.1 * self.em, first + 0.5 * pitch, 0.28 * self.em), None, light(0.8));
        }

        let mut write = |text: &Rc<Written>, x: f64, middle: f64, share: f32| {
            let rim = (text.width as f64 - text.ink_width()) / 2.0;
            let top = (middle - text.height as f64 / 2.0 + 0.02 * self.em).round();
            let placed = Line { text: Rc::clone(text), left: (x - rim).round() as i64, top: top as i64 };
            lay_text(picture, &placed.text, placed.left, placed.top, light(share));
        };
        write(&self.title, inner_left, first + 0.5 * pitch, 0.8);
        for (index, row) in self.rows.iter().enumerate() {
            let share = if row.under_bar { 1.25 } else { 0.85 };
            write(&row.label, inner_left + self.mark_width(), middle_of(index), share);
            write(&row.value, inner_right - row.value.ink_width(), middle_of(index), share);
        }
        if let Some(hint) = &self.hint {
            write(hint, inner_left, bottom - 0.9 * self.em, 0.6);
        }
    }
}

/// The right-most place for a box of a size, about half way up, at least `clearance` right of the middle.
fn right_side((width, height): (f64, f64), canvas: (usize, usize), clearance: f64, region: &Region) -> Option<Area> {
    const MARGIN: f64 = 8.0;
    let (middle_x, middle_y) = (canvas.0 as f64 / 2.0, canvas.1 as f64 / 2.0);
    // Leaves the words on top and the line at the bottom alone where the whole canvas is seen.
    if height > 0.66 * canvas.1 as f64 {
        return None;
    }
    (0..canvas.0)
        .step_by(2)
        .map(|step| canvas.0 as f64 - MARGIN - step as f64)
        .take_while(|right| right - width >= (middle_x + clearance).max(MARGIN))
        .map(|right| Area { left: right - width, right, top: middle_y - height / 2.0, bottom: middle_y + height / 2.0 })
        .find(|area| region.contains_box(&grown(area, MARGIN)))
}

fn grown(area: &Area, by: f64) -> Area {
    Area { left: area.left - by, top: area.top - by, right: area.right + by - 1.0, bottom: area.bottom + by }
}

/// A box with round corners.
fn rounded(area: &Area, radius: f64) -> Option<Path> {
    let [l, t, r, b, k] = [area.left, area.top, area.right, area.bottom, radius].map(|value| value as f32);
    let mut path = PathBuilder::new();
    path.move_to(l + k, t);
    path.line_to(r - k, t);
    path.quad_to(r, t, r, t + k);
    path.line_to(r, b - k);
    path.quad_to(r, b, r - k, b);
    path.line_to(l + k, b);
    path.quad_to(l, b, l, b - k);
    path.line_to(l, t + k);
    path.quad_to(l, t, l + k, t);
    path.close();
    path.finish()
}

/// A triangle about a point, its tip `height` below the middle (above, when negative).
fn triangle(x: f64, y: f64, height: f64) -> Option<Path> {
    let [x, y, h] = [x, y, height].map(|value| value as f32);
    let mut path = PathBuilder::new();
    path.move_to(x, y + h);
    path.line_to(x - h.abs() * 1.2, y - h);
    path.line_to(x + h.abs() * 1.2, y - h);
    path.close();
    path.finish()
}

#[cfg(test)]
mod tests {
    use super::super::compose::{Composer, Scene};
    use super::super::style::{Eye, Mode};
    use super::*;
    use crate::sky::catalogue::{Catalogue, Found};
    use crate::sky::coords::Equatorial;
    use crate::sky::field::FieldOfView;
    use crate::sky::optics::Instrument;
    use crate::units::Angle;

    fn menu(lines: usize, bar: usize) -> Menu {
        let line = |n: usize| Entry { label: format!("line {n}"), value: format!("{n}×"), chosen: n == bar };
        Menu {
            title: "eyepiece".into(),
            lines: (0..lines).map(line).collect(),
            bar: Some(bar),
            hint: "hold ?: choose".into(),
        }
    }

    fn drawn(menu: Option<&Menu>, eyepiece_mm: f64, mode: Mode) -> (Picture, FieldOfView) {
        let centre = Equatorial::new(Angle::degrees(283.4), Angle::degrees(33.0));
        let instrument = Instrument::default().with_eyepiece(eyepiece_mm);
        let field = FieldOfView::towards(&centre, Angle::ZERO, &instrument);
        let scene = Scene {
            found: &Found::default(),
            target: None,
            photographs: &[],
            catalogue: Catalogue::embedded(),
            animation: None,
            menu,
        };
        let style = Style { mode, ..Style::default() };
        (Composer::default().compose(&scene, &field, &Eye::default(), &style), field)
    }

    #[test]
    fn with_every_eyepiece_the_menu_is_red_and_inside_the_circle_on_the_right_side() {
        for mm in [32.0, 24.0, 15.0, 10.0, 5.0] {
            for lines in [1, 5, 10, 20] {
                let (with, field) = drawn(Some(&menu(lines, lines / 2)), mm, Mode::Over);
                let (without, _) = drawn(None, mm, Mode::Over);
                let radius = field.circle_px();
                let mut changed = 0;
                for (index, (on, off)) in with.pixels().iter().zip(without.pixels()).enumerate() {
                    let (x, y) = ((index % 1024) as f64 + 0.5 - 512.0, (index / 1024) as f64 + 0.5 - 384.0);
                    assert!(on[1] == 0.0 && on[2] == 0.0, "{mm} mm: text and marks are red");
                    if on != off {
                        changed += 1;
                        assert!(x.hypot(y) <= radius, "{mm} mm, {lines} lines: {x} {y} is beyond the circle");
                        assert!(x > 0.0 || mm < 6.0, "{mm} mm, {lines} lines: {x} {y} is on the left");
                    }
                }
                assert!(changed > 1000, "{mm} mm, {lines} lines: only {changed} pixels");
            }
        }
    }

    #[test]
    fn a_list_that_is_too_long_shows_the_lines_about_the_bar() {
        let mut scribe = Scribe::default();
        let region = Region::new(1024, 768, Vec::new());
        for bar in [0, 7, 39] {
            let placed = Placed::find(&menu(40, bar), &mut scribe, 20.0, (1024, 768), &region).unwrap();
            assert!(placed.rows.len() < 40 && placed.rows.iter().filter(|row| row.under_bar).count() == 1);
            assert_eq!(placed.more, (bar > placed.rows.len() / 2, bar < 39));
        }
    }

    #[test]
    fn switched_off_the_menu_alone_is_drawn_with_the_line_of_the_eyepiece() {
        let (picture, _) = drawn(Some(&menu(5, 1)), 24.0, Mode::Off);
        let lit = |rows: std::ops::Range<usize>| rows.flat_map(|y| picture.row(y).to_vec()).any(|pixel| pixel[0] > 0.2);
        assert!(lit(300..460) && lit(700..768), "the list and the line at the bottom");
        assert!(!lit(0..200), "no words about the sky");
        let (dark, _) = drawn(None, 24.0, Mode::Off);
        assert!(dark.is_black());
    }
}
