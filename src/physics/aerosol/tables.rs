//! The ten substances of OPAC: numbers as printed, typed in.
//!
//! Sizes, growth and refractive indices: Hess, Koepke & Schult (1998), Bull. Am. Meteorol. Soc. 79, 831, tables 1a to 1c, and
//! the component tables of OPAC 3.1 that the paper describes. Water: Hale & Querry (1973), Applied Optics 12, 555. The tables
//! print an index for each humidity as well; they are not here, because mixing the dry substance with this water by volume
//! gives every one of them within its last digit (388 of 389 pairs; the other, sulphate at 99 % and 500 nm, is misprinted).

/// Wavelengths of the refractive indices, nanometres.
pub(super) const WAVELENGTHS_NM: [f64; 13] =
    [300.0, 350.0, 400.0, 450.0, 500.0, 550.0, 600.0, 650.0, 700.0, 750.0, 800.0, 900.0, 1000.0];

/// Real part and imaginary part (positive: absorbing) at [`WAVELENGTHS_NM`].
pub(super) type Index = [(f64, f64); 13];

/// Relative humidity in percent; mode, smallest and largest radius in micrometres.
pub(super) type Grown = (f64, f64, f64, f64);

/// Water.
pub(super) const WATER: Index = [
    (1.349, 1.6e-8),
    (1.343, 6.5e-9),
    (1.339, 1.86e-9),
    (1.337, 1.02e-9),
    (1.335, 1.0e-9),
    (1.333, 1.96e-9),
    (1.332, 1.09e-8),
    (1.331, 1.64e-8),
    (1.331, 3.35e-8),
    (1.330, 1.56e-7),
    (1.329, 1.25e-7),
    (1.328, 4.86e-7),
    (1.327, 2.89e-6),
];

/// Insoluble: soil and organic dust.
pub(super) const INSOLUBLE: Index = [
    (1.53, 0.008),
    (1.53, 0.008),
    (1.53, 0.008),
    (1.53, 0.008),
    (1.53, 0.008),
    (1.53, 0.008),
    (1.53, 0.008),
    (1.53, 0.008),
    (1.53, 0.008),
    (1.53, 0.008),
    (1.52, 0.008),
    (1.52, 0.008),
    (1.52, 0.008),
];

/// Water-soluble: sulphates, nitrates, organics; dry.
pub(super) const WATER_SOLUBLE: Index = [
    (1.53, 0.008),
    (1.53, 0.005),
    (1.53, 0.005),
    (1.53, 0.005),
    (1.53, 0.005),
    (1.53, 0.006),
    (1.53, 0.006),
    (1.53, 0.007),
    (1.53, 0.007),
    (1.53, 0.0085),
    (1.52, 0.01),
    (1.52, 0.013),
    (1.52, 0.0155),
];

/// Soot.
pub(super) const SOOT: Index = [
    (1.74, 0.47),
    (1.75, 0.465),
    (1.75, 0.46),
    (1.75, 0.455),
    (1.75, 0.45),
    (1.75, 0.44),
    (1.75, 0.435),
    (1.75, 0.435),
    (1.75, 0.43),
    (1.75, 0.43),
    (1.75, 0.43),
    (1.75, 0.435),
    (1.76, 0.44),
];

/// Sea salt, both modes; dry.
pub(super) const SEA_SALT: Index = [
    (1.51, 2e-06),
    (1.51, 3.24e-07),
    (1.5, 3e-08),
    (1.5, 2.43e-08),
    (1.5, 1.55e-08),
    (1.5, 1e-08),
    (1.49, 1.6e-08),
    (1.49, 4.24e-08),
    (1.49, 2e-07),
    (1.49, 1.08e-06),
    (1.48, 1.95e-06),
    (1.48, 4.24e-05),
    (1.47, 0.000141),
];

/// Desert mineral, all four modes.
pub(super) const MINERAL: Index = [
    (1.53, 0.025),
    (1.53, 0.017),
    (1.53, 0.013),
    (1.53, 0.0085),
    (1.53, 0.0078),
    (1.53, 0.0055),
    (1.53, 0.0045),
    (1.53, 0.0045),
    (1.53, 0.004),
    (1.53, 0.004),
    (1.53, 0.004),
    (1.53, 0.004),
    (1.53, 0.004),
];

/// Droplets of 75 % sulphuric acid.
pub(super) const SULPHATE: Index = [
    (1.469, 1e-08),
    (1.452, 1e-08),
    (1.44, 1e-08),
    (1.432, 1e-08),
    (1.431, 1e-08),
    (1.43, 1e-08),
    (1.429, 1.47e-08),
    (1.429, 1.67e-08),
    (1.428, 2.05e-08),
    (1.427, 7.17e-08),
    (1.426, 8.63e-08),
    (1.425, 2.55e-07),
    (1.422, 1.53e-06),
];

/// Water-soluble particles, width 2.24.
pub(super) const WATER_SOLUBLE_SIZES: [Grown; 8] = [
    (0.0, 0.0212, 0.005, 20.0),
    (50.0, 0.0262, 0.006, 25.0),
    (70.0, 0.0285, 0.0064, 27.4),
    (80.0, 0.0306, 0.0067, 29.8),
    (90.0, 0.0348, 0.0071, 35.0),
    (95.0, 0.0399, 0.0074, 42.8),
    (98.0, 0.0476, 0.0078, 58.5),
    (99.0, 0.0534, 0.0079, 74.9),
];

/// Sea salt, accumulation mode, width 2.03.
pub(super) const SALT_ACCUMULATION_SIZES: [Grown; 8] = [
    (0.0, 0.209, 0.005, 20.0),
    (50.0, 0.336, 0.0077, 32.2),
    (70.0, 0.378, 0.0085, 36.3),
    (80.0, 0.416, 0.009, 39.9),
    (90.0, 0.497, 0.0099, 47.8),
    (95.0, 0.605, 0.0108, 58.5),
    (98.0, 0.801, 0.0115, 78.3),
    (99.0, 0.995, 0.0118, 98.6),
];

/// Sea salt, coarse mode, width 2.03.
pub(super) const SALT_COARSE_SIZES: [Grown; 8] = [
    (0.0, 1.75, 0.005, 60.0),
    (50.0, 2.82, 0.0077, 90.5),
    (70.0, 3.17, 0.0085, 100.0),
    (80.0, 3.49, 0.009, 100.0),
    (90.0, 4.18, 0.0099, 100.0),
    (95.0, 5.11, 0.0108, 100.0),
    (98.0, 6.84, 0.0115, 100.0),
    (99.0, 8.59, 0.0118, 100.0),
];

/// Sulphuric acid, width 2.03.
pub(super) const SULPHATE_SIZES: [Grown; 8] = [
    (0.0, 0.0695, 0.005, 20.0),
    (50.0, 0.098, 0.0073, 30.2),
    (70.0, 0.109, 0.0079, 33.6),
    (80.0, 0.118, 0.0084, 36.4),
    (90.0, 0.135, 0.009, 42.3),
    (95.0, 0.158, 0.0096, 50.2),
    (98.0, 0.195, 0.0101, 65.5),
    (99.0, 0.231, 0.0103, 81.8),
];
