//! Who may use whom: the imports in `src/**` held against the table of `docs/architecture.md`, and the documents and
//! fixtures held against what is there.

#![expect(clippy::expect_used, reason = "a test fails by panicking")]

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Each module of the crate with the modules it may name. `hw` and `app` may use less of some; see `NARROW`.
const ALLOWED: &[(&str, &[&str])] = &[
    ("units", &[]),
    ("numerics", &["units"]),
    ("picture", &["units"]),
    ("physics", &["units", "numerics", "picture"]),
    ("eye", &["units"]),
    ("registration", &["units", "numerics"]),
    ("report", &["units", "numerics", "picture", "physics", "eye", "registration"]),
    ("sky", &["units", "numerics", "physics", "eye"]),
    ("overlay", &["units", "picture", "physics", "eye", "sky"]),
    ("hw", &["units", "numerics", "picture", "sky"]),
    ("safety", &["units", "sky"]),
    ("pipeline", &["units", "picture", "sky", "overlay"]),
    ("app", &["units", "picture", "eye", "sky", "overlay", "safety", "pipeline", "hw"]),
    ("tui", &["units", "picture", "eye", "app"]),
];

/// Where a module may use only the plain types of another: (user, used, the parts that are plain).
const NARROW: &[(&str, &str, &[&str])] = &[
    ("hw", "sky", &["coords", "site", "time", "pointing", "horizon"]),
    (
        "app",
        "hw",
        &["mount::belief", "mount::order", "mount::report", "mount::reconcile", "mount::estimate", "handbox::Pressed"],
    ),
];

/// The thin adapters: the only library files that touch the outside world.
const ADAPTERS: &[&str] = &[
    "src/hw/i2c/linux.rs",
    "src/hw/i2c/pace.rs",
    "src/hw/i2c/pi.rs",
    "src/hw/light/fake/stored.rs",
    "src/hw/light/guard.rs",
    "src/hw/port.rs",
    "src/hw/projector.rs",
    "src/hw/serial.rs",
    "src/hw/pty.rs",
    "src/hw/handbox/presenter.rs",
    "src/hw/handbox/sim/serve.rs",
    "src/hw/handbox/tap.rs",
    "src/hw/handbox/tap/line.rs",
    "src/hw/tcp.rs",
    "src/hw/trace.rs",
    "src/hw/supervisor.rs",
    "src/hw/mount/link.rs",
    "src/hw/projector.rs",
    "src/hw/projector/folder.rs",
    "src/hw/projector/framebuffer.rs",
    "src/hw/projector/ioctl.rs",
    "src/hw/projector/window.rs",
    "src/hw/mount/sim/serve.rs",
    "src/hw/mount/sim/serve/pty.rs",
    "src/hw/mount/sim/serve/tcp.rs",
];

/// Words that stand for a device, a file, a thread or a clock.
const OUTSIDE_WORLD: &[&str] =
    &["std::fs", "std::thread", "std::net", "std::process", "Instant::now", "SystemTime", "serialport::"];

/// All files below a folder.
fn files_below(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            files_below(&path, found);
        } else {
            found.push(path);
        }
    }
}

fn all_sources() -> Vec<PathBuf> {
    let mut files = Vec::new();
    files_below(Path::new("src"), &mut files);
    files.retain(|path| path.extension().is_some_and(|e| e == "rs"));
    assert!(files.len() > 10, "src was not found: run the tests from the root of the project");
    files
}

/// The code of a file without comment lines and without its test module.
fn code(path: &Path) -> String {
    let text = fs::read_to_string(path).expect("a source file is text");
    let body = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    body.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n")
}

/// The module a file belongs to: `src/sky/time.rs` and `src/sky.rs` are `sky`.
fn module(path: &Path) -> String {
    let inside = path.strip_prefix("src").expect("a path in src");
    let first = inside.components().next().expect("a name").as_os_str().to_string_lossy().into_owned();
    first.trim_end_matches(".rs").to_owned()
}

/// What a file names of its own crate, each path as written after `crate::`, one level of `{a, b::c}` opened.
fn uses(code: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for (at, _) in code.match_indices("crate::") {
        let rest = &code[at + "crate::".len()..];
        let head: String = rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_' || *c == ':').collect();
        match rest[head.len()..].strip_prefix('{') {
            Some(group) => found.extend(group_items(group).into_iter().map(|item| format!("{head}{item}"))),
            None => drop(found.insert(head)),
        }
    }
    found.into_iter().map(|path| path.trim_matches(':').to_owned()).filter(|path| !path.is_empty()).collect()
}

/// The items of a group `a, b::{c, d}}...`, inner groups left out.
fn group_items(group: &str) -> Vec<String> {
    let mut items = vec![String::new()];
    let mut depth = 0;
    for c in group.chars() {
        match (c, depth) {
            ('}', 0) => break,
            ('{', _) => depth += 1,
            ('}', _) => depth -= 1,
            (',', 0) => items.push(String::new()),
            (_, 0) if !c.is_whitespace() => items.last_mut().expect("never empty").push(c),
            _ => {}
        }
    }
    items.retain(|item| !item.is_empty());
    items
}

#[test]
fn modules_use_only_what_the_table_allows() {
    let table: BTreeMap<&str, &[&str]> = ALLOWED.iter().copied().collect();
    let mut wrong = Vec::new();
    for path in all_sources() {
        let here = module(&path);
        if matches!(here.as_str(), "lib" | "main" | "cli") {
            continue;
        }
        let Some(allowed) = table.get(here.as_str()) else {
            wrong.push(format!("{}: module '{here}' is not in the table", path.display()));
            continue;
        };
        for used in uses(&code(&path)) {
            let (top, below) = used.split_once("::").unwrap_or((&used, ""));
            if top == here || (!table.contains_key(top) && top != "cli") {
                continue;
            }
            if !allowed.contains(&top) {
                wrong.push(format!("{}: {here} may not use crate::{used}", path.display()));
            }
            let narrowed = NARROW.iter().find(|(user, target, _)| *user == here && *target == top);
            if let Some((_, _, plain)) = narrowed
                && !plain.iter().any(|part| below.starts_with(part))
            {
                wrong.push(format!("{}: {here} may use only {plain:?} of {top}, not crate::{used}", path.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "arrows that the architecture forbids:\n{}", wrong.join("\n"));
}

#[test]
fn the_arrows_between_modules_never_run_in_a_circle() {
    let order: Vec<&str> = ALLOWED.iter().map(|(module, _)| *module).collect();
    for (module, allowed) in ALLOWED {
        let place = order.iter().position(|m| m == module);
        assert!(allowed.iter().all(|used| order.iter().position(|m| m == used) < place), "{module} points forward");
    }
}

#[test]
fn the_terminal_library_is_named_only_in_tui() {
    let wrong: Vec<_> = all_sources()
        .into_iter()
        .filter(|path| !matches!(module(path).as_str(), "tui" | "cli" | "main"))
        .filter(|path| code(path).contains("ratatui") || code(path).contains("crossterm"))
        .collect();
    assert!(wrong.is_empty(), "ratatui or crossterm outside tui: {wrong:?}");
}

#[test]
fn files_threads_clocks_and_sockets_stay_in_the_adapters() {
    let mut wrong = Vec::new();
    for path in all_sources() {
        let adapter = ADAPTERS.iter().any(|a| path.ends_with(a)) || path.starts_with("src/hw/projector");
        if adapter || matches!(module(&path).as_str(), "cli" | "main") {
            continue;
        }
        let code = code(&path);
        wrong.extend(OUTSIDE_WORLD.iter().filter(|w| code.contains(**w)).map(|w| format!("{}: {w}", path.display())));
    }
    assert!(wrong.is_empty(), "the outside world in pure code:\n{}", wrong.join("\n"));
}

#[test]
fn random_numbers_come_only_with_a_seed_handed_in() {
    let wrong: Vec<_> = all_sources()
        .into_iter()
        .filter(|path| !path.ends_with("numerics/streams.rs"))
        .filter(|path| {
            let code = code(path);
            ["rand::", "rand_pcg", "thread_rng", "from_os_rng", "getrandom"].iter().any(|word| code.contains(word))
        })
        .collect();
    assert!(wrong.is_empty(), "random numbers outside numerics::streams: {wrong:?}");
}

#[test]
fn every_path_that_the_documents_name_exists() {
    let mut documents = vec![PathBuf::from("README.md")];
    files_below(Path::new("docs"), &mut documents);
    documents.retain(|path| path.extension().is_some_and(|e| e == "md"));
    let mut wrong = Vec::new();
    for document in documents {
        let text = fs::read_to_string(&document).unwrap_or_default();
        for quoted in text.split('`').skip(1).step_by(2) {
            let folders = ["src/", "docs/", "tests/", "fixtures/", "benches/", "packaging/", "fuzz/"];
            let is_path = folders.iter().any(|f| quoted.starts_with(f)) && !quoted.contains(['*', ' ', '<', '{', '\n']);
            if is_path && !Path::new(quoted.trim_end_matches('/')).exists() {
                wrong.push(format!("{}: {quoted}", document.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "documents name what is not there:\n{}", wrong.join("\n"));
}

#[test]
fn every_fixture_has_its_origin_in_the_manifest() {
    let manifest = fs::read_to_string("fixtures/MANIFEST.toml").expect("fixtures/MANIFEST.toml");
    let table: toml::Table = manifest.parse().expect("the manifest is TOML");
    let entries = table.get("file").and_then(toml::Value::as_array).cloned().unwrap_or_default();
    let mut listed = BTreeSet::new();
    for entry in &entries {
        let text = |key: &str| entry.get(key).and_then(toml::Value::as_str).filter(|t| !t.is_empty());
        for key in ["path", "origin", "licence", "made_by"] {
            assert!(text(key).is_some(), "the manifest's entry {entry} lacks {key}");
        }
        listed.extend(text("path").map(|path| Path::new("fixtures").join(path)));
    }
    let mut present = Vec::new();
    files_below(Path::new("fixtures"), &mut present);
    let orphans: Vec<_> = present.iter().filter(|p| !p.ends_with("MANIFEST.toml") && !listed.contains(*p)).collect();
    let ghosts: Vec<_> = listed.iter().filter(|path| !path.exists()).collect();
    assert!(orphans.is_empty(), "fixtures without an origin: {orphans:?}");
    assert!(ghosts.is_empty(), "the manifest lists what is not there: {ghosts:?}");
}
