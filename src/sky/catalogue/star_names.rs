//! The stars' names, as the program holds them.

use super::constellation;

/// The 24 letters: as written, abbreviated as in the catalogues, in full, and other spellings.
pub(super) const GREEK: [(char, &str, &str, &str); 24] = [
    ('α', "alp", "alpha", "alf"),
    ('β', "bet", "beta", ""),
    ('γ', "gam", "gamma", ""),
    ('δ', "del", "delta", ""),
    ('ε', "eps", "epsilon", ""),
    ('ζ', "zet", "zeta", ""),
    ('η', "eta", "eta", ""),
    ('θ', "the", "theta", "tet"),
    ('ι', "iot", "iota", ""),
    ('κ', "kap", "kappa", ""),
    ('λ', "lam", "lambda", ""),
    ('μ', "mu", "mu", ""),
    ('ν', "nu", "nu", ""),
    ('ξ', "xi", "xi", "ksi"),
    ('ο', "omi", "omicron", ""),
    ('π', "pi", "pi", ""),
    ('ρ', "rho", "rho", ""),
    ('σ', "sig", "sigma", ""),
    ('τ', "tau", "tau", ""),
    ('υ', "ups", "upsilon", ""),
    ('φ', "phi", "phi", ""),
    ('χ', "chi", "chi", "khi"),
    ('ψ', "psi", "psi", ""),
    ('ω', "ome", "omega", "omg"),
];

/// The names of one star; the text stays where it is in the program.
#[derive(Debug, Clone, Copy)]
pub(super) struct StarNames {
    pub(super) hip: u32,
    pub(super) constellation: &'static str,
    /// `α1`
    pub(super) bayer: &'static str,
    pub(super) flamsteed: &'static str,
    pub(super) variable: &'static str,
    pub(super) henry_draper: &'static str,
    /// Proper names cut by semicolons.
    pub(super) proper: &'static str,
}

impl StarNames {
    /// Reads the file, which is in the order of the HIP numbers.
    pub(super) fn read_all(text: &'static str) -> Vec<StarNames> {
        text.lines().filter(|line| !line.starts_with('#')).filter_map(StarNames::read).collect()
    }

    fn read(line: &'static str) -> Option<StarNames> {
        let mut cells = line.split('\t');
        Some(StarNames {
            hip: cells.next()?.parse().ok()?,
            constellation: cells.next()?,
            bayer: cells.next()?,
            flamsteed: cells.next()?,
            variable: cells.next()?,
            henry_draper: cells.next()?,
            proper: cells.next()?,
        })
    }

    /// Bayer's letter without its number.
    pub(super) fn letter(&self) -> Option<char> {
        self.bayer.chars().next()
    }

    /// The number behind Bayer's letter, 0 if there is none.
    pub(super) fn index(&self) -> u8 {
        self.bayer.chars().nth(1).and_then(|digit| digit.to_digit(10)).map_or(0, |digit| digit as u8)
    }

    /// Every name, the one to show first: proper names, Bayer's, Flamsteed's, the variable star's, HIP, HD.
    pub(super) fn all(&self) -> Vec<String> {
        let mut names: Vec<String> =
            self.proper.split(';').filter(|name| !name.is_empty()).map(str::to_owned).collect();
        let con = self.constellation;
        if !con.is_empty() {
            let designations = [self.bayer, self.flamsteed, self.variable];
            names.extend(designations.iter().filter(|text| !text.is_empty()).map(|text| format!("{text} {con}")));
            if let Some(full) = self.bayer_in_full() {
                names.push(full);
            }
        }
        names.push(format!("HIP {}", self.hip));
        if !self.henry_draper.is_empty() {
            names.push(format!("HD {}", self.henry_draper));
        }
        names
    }

    /// `alpha1 Centauri`.
    pub(super) fn bayer_in_full(&self) -> Option<String> {
        let letter = self.letter()?;
        let name = GREEK.iter().find(|row| row.0 == letter)?.2;
        let index = &self.bayer[letter.len_utf8()..];
        Some(format!("{name}{index} {}", constellation::genitive(self.constellation)))
    }
}
