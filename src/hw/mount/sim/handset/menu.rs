//! A small part of the menu tree, and the Messier objects that the simulated library knows.

/// One line of a menu.
pub(super) struct Item {
    pub(super) text: &'static str,
    pub(super) inside: Inside,
}

/// What ENTER opens.
pub(super) enum Inside {
    Items(&'static [Item]),
    Text(&'static str),
    /// The entry of a Messier number.
    Messier,
}

const fn items(text: &'static str, inside: &'static [Item]) -> Item {
    Item { text, inside: Inside::Items(inside) }
}

const fn leaf(text: &'static str, inside: &'static str) -> Item {
    Item { text, inside: Inside::Text(inside) }
}

/// The first menu.
pub(super) const MENU: &[Item] = &[
    items(
        "Object",
        &[
            items("Solar System", &[leaf("Moon", "Not simulated"), leaf("Jupiter", "Not simulated")]),
            items("Deep Sky", &[Item { text: "Messier Object", inside: Inside::Messier }]),
            items("Star", &[leaf("Named", "Not simulated")]),
        ],
    ),
    items("Event", &[leaf("Sunrise", "Not simulated"), leaf("Sunset", "Not simulated")]),
    leaf("Guided Tour", "Not simulated"),
    leaf("Glossary", "Not simulated"),
    items("Utilities", &[leaf("Timer", "00:00:00"), leaf("Battery Alarm", "On")]),
    items("Setup", &[leaf("Align", "Aligned"), leaf("Telescope", "10 inch LX200")]),
];

/// Number, right ascension and declination of J2000 in degrees, kind and magnitude, from the NGC as OpenNGC has it.
const MESSIER: [(usize, f64, f64, &str); 8] = [
    (1, 83.633, 22.014, "SNR mag 8.4"),
    (13, 250.423, 36.461, "GLOB mag 5.8"),
    (27, 299.902, 22.721, "PN mag 7.4"),
    (31, 10.685, 41.269, "EX GAL mag 3.4"),
    (42, 83.819, -5.387, "NEB mag 4.0"),
    (45, 56.601, 24.114, "OPEN mag 1.2"),
    (51, 202.470, 47.195, "GAL mag 8.4"),
    (57, 283.396, 33.029, "PN mag 8.8"),
];

/// The items of the level that a path leads to, and which of them is chosen.
pub(super) fn level(path: &[usize]) -> (&'static [Item], usize) {
    let (last, before) = path.split_last().unwrap_or((&0, &[]));
    let inside = before.iter().fold(MENU, |level, chosen| match level.get(*chosen).map(|item| &item.inside) {
        Some(Inside::Items(inside)) => inside,
        _ => level,
    });
    (inside, (*last).min(inside.len() - 1))
}

/// The title of a level and the chosen item.
pub(super) fn titles(path: &[usize]) -> (&'static str, &'static str) {
    let (items, chosen) = level(path);
    let title = match path.split_last() {
        Some((_, before)) if !before.is_empty() => {
            let (above, entered) = level(before);
            above[entered].text
        }
        _ => "Select Item",
    };
    (title, items[chosen].text)
}

/// The path to the item that asks for a Messier number.
pub(super) fn messier() -> Vec<usize> {
    vec![0, 1, 0]
}

/// Where a Messier object stands in this year, degrees of date, if the simulated library knows it: to an arcminute.
///
/// ```text
/// d ra / dt = m + n sin(ra) tan(dec)     d dec / dt = n cos(ra)      m = 46.124, n = 20.043 arcseconds a year
/// ```
///
/// Meeus, Astronomical Algorithms, ch. 21 (low accuracy).
pub(in super::super) fn messier_position(number: usize, year: f64) -> Option<(f64, f64)> {
    let object = MESSIER.iter().find(|object| object.0 == number)?;
    let (ra, dec) = (object.1.to_radians(), object.2.to_radians());
    let years = year - 2000.0;
    let d_ra = (46.124 + 20.043 * ra.sin() * dec.tan()) * years / 3600.0;
    Some((object.1 + d_ra, object.2 + 20.043 * ra.cos() * years / 3600.0))
}

/// The second line of a Messier object.
pub(super) fn facts(number: usize) -> &'static str {
    MESSIER.iter().find(|object| object.0 == number).map_or("", |object| object.3)
}

/// All nodes as (path, next sibling, first child), each with its place in the list. The firmware's addresses of the first
/// three are known from a capture (`:EQ 0#` gives `3820 3852 Object#`); the rest go on in the same steps.
fn nodes() -> Vec<Vec<usize>> {
    let mut found = Vec::new();
    walk(vec![0], &mut found);
    found
}

fn walk(path: Vec<usize>, found: &mut Vec<Vec<usize>>) {
    let (items, chosen) = level(&path);
    let sibling = (chosen + 1 < items.len()).then(|| with_last(&path, chosen + 1));
    let child = matches!(items[chosen].inside, Inside::Items(_)).then(|| [&path[..], &[0]].concat());
    if found.is_empty() {
        found.push(path);
    }
    found.extend([&sibling, &child].into_iter().flatten().cloned());
    for next in [sibling, child].into_iter().flatten() {
        walk(next, found);
    }
}

fn with_last(path: &[usize], last: usize) -> Vec<usize> {
    let mut path = path.to_vec();
    if let Some(place) = path.last_mut() {
        *place = last;
    }
    path
}

fn address(path: &[usize]) -> usize {
    match nodes().iter().position(|node| node == path) {
        None | Some(0) => 0,
        Some(place) => 3820 + 32 * (place - 1),
    }
}

/// The path of an address.
pub(super) fn path(wanted: usize) -> Option<Vec<usize>> {
    nodes().into_iter().find(|node| address(node) == wanted)
}

/// `next enter text` of an address; 0 is nothing there.
pub(super) fn node(wanted: usize) -> Option<String> {
    let path = path(wanted)?;
    let (items, chosen) = level(&path);
    let next = if chosen + 1 < items.len() { address(&with_last(&path, chosen + 1)) } else { 0 };
    let enter = if matches!(items[chosen].inside, Inside::Items(_)) { address(&[&path[..], &[0]].concat()) } else { 0 };
    Some(format!("{next} {enter} {}", items[chosen].text))
}
