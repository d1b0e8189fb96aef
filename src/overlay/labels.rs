//! Names beside what they name, without overlap: the most important first, each at the first free place around its mark,
//! farther away with a leader line, or left out.

use super::canvas::{Area, Region};

/// A name to place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wanted {
    /// What it names: the middle of the mark, in pixels.
    pub x: f64,
    /// Downwards.
    pub y: f64,
    /// Radius of the mark.
    pub radius: f64,
    /// Width of the written name.
    pub width: f64,
    /// Its height.
    pub height: f64,
}

/// Where a name goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placed {
    /// Which of the wanted.
    pub index: usize,
    /// Its box.
    pub area: Area,
    /// A line from the mark to the name, when it had to move away.
    pub leader: Option<((f64, f64), (f64, f64))>,
}

/// Where around its mark a name may stand, the best first: (right, down) of the name's middle.
const SIDES: [(f64, f64); 8] =
    [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0), (0.75, 0.75), (0.75, -0.75), (-0.75, 0.75), (-0.75, -0.75)];
/// Gaps between mark and name, in pixels; from the second on a leader line is drawn.
const GAPS: [f64; 4] = [4.0, 18.0, 34.0, 54.0];

/// Places names, in the order given. `taken` are boxes that must stay free: they are kept out of, and grow by each name.
#[must_use]
pub fn place(wanted: &[Wanted], region: &Region, taken: &mut Vec<Area>) -> Vec<Placed> {
    let mut placed = Vec::new();
    for (index, name) in wanted.iter().enumerate() {
        let free = |area: &Area| region.contains_box(area) && !taken.iter().any(|other| other.meets(area));
        let places = GAPS.iter().flat_map(|&gap| SIDES.iter().map(move |&side| (gap, side)));
        let found = places.map(|(gap, side)| (gap, beside(name, gap, side))).find(|(_, area)| free(area));
        if let Some((gap, area)) = found {
            taken.push(area);
            placed.push(Placed { index, area, leader: (gap > GAPS[0]).then(|| leader(name, &area)) });
        }
    }
    placed
}

/// The box of a name on one side of its mark.
fn beside(name: &Wanted, gap: f64, (right, down): (f64, f64)) -> Area {
    let away = name.radius + gap;
    // The name's nearest edge touches the gap's circle: its middle is half its size farther out.
    let x = name.x + right * away + right.signum() * f64::from(right != 0.0) * name.width / 2.0;
    let y = name.y + down * away + down.signum() * f64::from(down != 0.0) * name.height / 2.0;
    Area::about(x, y, name.width / 2.0, name.height / 2.0)
}

/// From the rim of the mark to the nearest point of the box.
fn leader(name: &Wanted, area: &Area) -> ((f64, f64), (f64, f64)) {
    let (x, y) = (name.x.clamp(area.left, area.right), name.y.clamp(area.top, area.bottom));
    let length = (x - name.x).hypot(y - name.y).max(1.0);
    let part = (name.radius + 2.0).min(length) / length;
    ((name.x + (x - name.x) * part, name.y + (y - name.y) * part), (x, y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_lone_name_stands_right_of_its_mark() {
        let name = Wanted { x: 100.0, y: 100.0, radius: 3.0, width: 40.0, height: 12.0 };
        let placed = place(&[name], &Region::new(1024, 768, vec![]), &mut Vec::new());
        assert_eq!(placed[0].area, Area { left: 107.0, top: 94.0, right: 147.0, bottom: 106.0 });
        assert_eq!(placed[0].leader, None);
    }

    #[test]
    fn a_name_at_the_right_edge_moves_to_the_left() {
        let name = Wanted { x: 1010.0, y: 100.0, radius: 3.0, width: 40.0, height: 12.0 };
        let placed = place(&[name], &Region::new(1024, 768, vec![]), &mut Vec::new());
        assert_eq!(placed[0].area.right, 1003.0);
    }

    proptest! {
        #[test]
        fn names_never_overlap_leave_the_region_or_touch_what_is_taken(
            marks in prop::collection::vec((0.0..1024.0, 0.0..768.0, 1.0..40.0, 8.0..160.0), 1..60)
        ) {
            let wanted: Vec<Wanted> =
                marks.iter().map(|&(x, y, radius, width)| Wanted { x, y, radius, width, height: 16.0 }).collect();
            let region = Region::new(1024, 768, vec![super::super::canvas::Disc { x: 512.0, y: 384.0, radius: 420.0 }]);
            let target = Area::about(512.0, 384.0, 20.0, 20.0);
            let mut taken = vec![target];
            let placed = place(&wanted, &region, &mut taken);
            for (i, one) in placed.iter().enumerate() {
                prop_assert!(region.contains_box(&one.area));
                prop_assert!(!one.area.meets(&target));
                prop_assert!(placed[i + 1..].iter().all(|other| !other.area.meets(&one.area)));
            }
        }
    }
}
