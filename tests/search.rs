//! What a person types, and what they mean by it.

use proptest::prelude::*;
use scotopic::sky::catalogue::{Catalogue, SearchError};

/// What is typed, and a name of the object that is meant.
const TABLE: [(&str, &str); 92] = [
    ("M31", "NGC 224"),
    ("m 31", "NGC 224"),
    ("messier 31", "NGC 224"),
    ("Messier031", "NGC 224"),
    ("ngc 224", "M31"),
    ("NGC0224", "M31"),
    ("NGC-224", "M31"),
    ("andromeda galaxy", "M31"),
    ("Andromeda", "M31"),
    ("ANDROMEDA   GALAXY", "M31"),
    ("M1", "Crab Nebula"),
    ("crab nebula", "M1"),
    ("M40", "M40"),
    ("M45", "Pleiades"),
    ("pleiades", "M45"),
    ("Seven Sisters", "M45"),
    ("M102", "M101"),
    ("pinwheel galaxy", "M101"),
    ("M57", "Ring Nebula"),
    ("ring nebula", "NGC 6720"),
    ("C 14", "Double Cluster"),
    ("Caldwell 14", "C14"),
    ("double cluster", "C14"),
    ("h Persei", "NGC 869"),
    ("caldwell 49", "Rosette Nebula"),
    ("C80", "NGC 5139"),
    ("omega centauri", "NGC 5139"),
    ("47 Tuc", "NGC 104"),
    ("47 Tucanae", "NGC 104"),
    ("IC 434", "IC 434"),
    ("horsehead nebula", "B 33"),
    ("Barnard 33", "B 33"),
    ("NGC 2244", "C50"),
    ("NGC 7789", "Herschel 400"),
    ("Mel 111", "Coma Star Cluster"),
    ("Melotte 22", "M45"),
    ("Collinder 399", "Coathanger Asterism"),
    ("lmc", "Large Magellanic Cloud"),
    ("stephan's quintet", "HCG 92"),
    ("Stephans Quintet", "HCG 92"),
    ("30 Dor", "NGC 2070"),
    ("Polaris", "HIP 11767"),
    ("north star", "HIP 11767"),
    ("HIP 11767", "Polaris"),
    ("hip11767", "Polaris"),
    ("HIP 1", "HIP 1"),
    ("HD 8890", "Polaris"),
    ("alpha UMi", "Polaris"),
    ("1 UMi", "Polaris"),
    ("alpha centauri", "HIP 71683"),
    ("Alpha Cen", "HIP 71683"),
    ("α Cen", "HIP 71683"),
    ("αCen", "HIP 71683"),
    ("alf cen", "HIP 71683"),
    ("alp Cen", "HIP 71683"),
    ("alphacen", "HIP 71683"),
    ("alpha1 Cen", "HIP 71683"),
    ("α¹ Cen", "HIP 71683"),
    ("alpha2 Cen", "HIP 71681"),
    ("alpha Cen A", "HIP 71683"),
    ("alpha cen b", "HIP 71681"),
    ("Rigil Kentaurus", "HIP 71683"),
    ("rigil kent", "HIP 71683"),
    ("Toliman", "HIP 71681"),
    ("Proxima Centauri", "HIP 70890"),
    ("61 Cyg", "HIP 104214"),
    ("61 Cygni", "HIP 104214"),
    ("61cyg", "HIP 104214"),
    ("61 Cyg A", "HIP 104214"),
    ("61 Cyg B", "HIP 104217"),
    ("beta1 sco", "Acrab"),
    ("beta sco", "Acrab"),
    ("β¹Sco", "Acrab"),
    ("beta2 Scorpii", "HIP 78821"),
    ("beta Cygni", "Albireo"),
    ("albireo", "HIP 95947"),
    ("alpha lib", "Zubenelgenubi"),
    ("alpha canis majoris", "Sirius"),
    ("α CMa", "Sirius"),
    ("alpha leonis", "Regulus"),
    ("beta leonis minoris", "β LMi"),
    ("theta2 Orionis", "HIP 26235"),
    ("tet2 Ori", "HIP 26235"),
    ("gamma andromedae", "Almach"),
    ("epsilon lyrae", "HIP 91919"),
    ("xi UMa", "Alula Australis"),
    ("ksi uma", "Alula Australis"),
    ("g UMa", "Alcor"),
    ("80 UMa", "Alcor"),
    ("50 alpha Cygni", "Deneb"),
    ("gam cyg", "Sadr"),
    ("Barnards star", "HIP 87937"),
];

#[test]
fn what_people_type_finds_what_they_mean() {
    let wrong: Vec<String> = TABLE
        .iter()
        .filter_map(|(typed, meant)| match Catalogue::embedded().search(typed) {
            Ok(found) if found.names.iter().any(|name| name == meant) => None,
            Ok(found) => Some(format!("{typed}: {:?}, not {meant}", found.names)),
            Err(error) => Some(format!("{typed}: {error}")),
        })
        .collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn near_misses_are_offered() {
    for (typed, meant) in [
        ("polrais", "Polaris"),
        ("andromedia galaxy", "Andromeda Galaxy"),
        ("betelguese", "Betelgeuse"),
        ("ring nebual", "Ring Nebula"),
        ("M111", "M11"),
        ("alpha centari", "Alpha Centauri A"),
        ("whirpool galaxy", "Whirlpool Galaxy"),
    ] {
        let Err(SearchError::NotFound { near, .. }) = Catalogue::embedded().search(typed) else {
            panic!("{typed} was found")
        };
        assert!(near.iter().any(|name| name == meant), "{typed}: {near:?}");
    }
}

#[test]
fn nothing_and_the_planets_are_answered_honestly() {
    let catalogue = Catalogue::embedded();
    assert_eq!(catalogue.search("  \u{1b}[2J "), Err(SearchError::Empty));
    for name in ["Sun", "the Moon", "JUPITER", "saturn"] {
        assert!(matches!(catalogue.search(name), Err(SearchError::Moving { .. })), "{name}");
    }
    assert!(matches!(catalogue.search("HIP 999999"), Err(SearchError::NotFound { .. })));
    assert!(matches!(catalogue.search("HIP 99999999999999999999"), Err(SearchError::NotFound { .. })));
    assert!(matches!(catalogue.search("M0"), Err(SearchError::NotFound { .. })));
}

#[test]
fn escapes_never_come_back_from_an_unknown_name() {
    let error = Catalogue::embedded().search("\u{1b}]0;gotcha\u{7}\u{9b}31mXyzzy\u{1b}[31m").unwrap_err();
    assert!(error.to_string().chars().all(|c| !c.is_control()), "{error:?}");
}

#[test]
fn completions_begin_as_typed_and_the_best_known_come_first() {
    let catalogue = Catalogue::embedded();
    assert_eq!(catalogue.complete("androm", 3)[0], "Andromeda");
    assert_eq!(catalogue.complete("M3", 3)[0], "M3");
    assert!(catalogue.complete("veg", 5).contains(&String::from("Vega")));
    assert!(catalogue.complete("", 5).is_empty());
    assert!(catalogue.complete("ngc", 7).len() == 7);
}

proptest! {
    #[test]
    fn no_text_makes_it_panic_or_print_an_escape(text in any::<String>()) {
        let catalogue = Catalogue::embedded();
        if let Err(error) = catalogue.search(&text) {
            prop_assert!(error.to_string().chars().all(|c| !c.is_control()));
        }
        prop_assert!(catalogue.complete(&text, 4).len() <= 4);
    }

    #[test]
    fn nothing_that_looks_like_a_name_makes_it_panic(
        text in "[ \\t'-]{0,2}(M|NGC|IC|C|HIP|HD|alpha|α|βγ|the|61|Cen|Cygni|UMa|[a-z]{0,12})[ 0-9¹²αΩéß.]{0,40}(Cen|Tauri|b|A)?"
    ) {
        let _ = Catalogue::embedded().search(&text);
        let _ = Catalogue::embedded().complete(&text, 5);
    }

    #[test]
    fn any_messier_number_is_found_however_it_is_spaced(number in 1..=110u32, spaces in " {0,3}", zeros in "0{0,2}") {
        let found = Catalogue::embedded().search(&format!("m{spaces}{zeros}{number}")).unwrap();
        let name = format!("M{number}");
        prop_assert!(found.names.contains(&name));
    }
}
