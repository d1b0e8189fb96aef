//! The embedded catalogue files are what `scotopic catalogue pack` makes of the published tables.

use std::path::Path;
use std::process::Command;

#[test]
fn packing_the_tables_again_gives_the_same_bytes() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let tables = root.join("../shared/data/sky");
    if !tables.join("hipparcos_merged.csv.gz").exists() {
        eprintln!("skipped: the published tables are not in {}", tables.display());
        return;
    }
    let out = std::env::temp_dir().join(format!("scotopic-repack-{}", std::process::id()));
    std::fs::create_dir_all(&out).unwrap();
    let packed = Command::new(env!("CARGO_BIN_EXE_scotopic"))
        .args(["catalogue", "pack", "--from"])
        .arg(&tables)
        .arg("--out")
        .arg(&out)
        .output()
        .unwrap();
    assert!(packed.status.success(), "{}", String::from_utf8_lossy(&packed.stderr));
    for name in ["hipparcos.bin", "faint_stars.bin", "star_names.tsv", "openngc.tsv"] {
        let embedded = std::fs::read(root.join("src/sky/catalogue/data").join(name)).unwrap();
        assert!(std::fs::read(out.join(name)).unwrap() == embedded, "{name} differs: run scotopic catalogue pack");
    }
    std::fs::remove_dir_all(&out).unwrap();
}
