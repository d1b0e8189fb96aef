//! Gathered light as bytes and back, so that it may be kept: little-endian, and a hash at the end by which a torn file is told.

use glam::DVec3;

use super::{Field, Told};
use crate::numerics::hash::fnv;
use crate::physics::dust::multiple::MOST_CELLS;
use crate::physics::dust::multiple::cells::NONE;
use crate::physics::dust::multiple::harmonics::{HIGHEST, Harmonics};
use crate::physics::dust::multiple::walk::LANES;
use crate::physics::dust::scene::MOST_BANDS;

/// What a file begins with; the number changes with the layout.
const MAGIC: &[u8; 16] = b"scotopic field 1";

impl Field {
    /// All of it as bytes.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(256 + 4 * (self.slots.len() + self.coefficients.len()));
        bytes.extend(MAGIC);
        let Told { photons, flights, most_scatterings, cells, noise, beyond, cut } = self.told;
        let [x, y, z] = self.size;
        for number in [x, y, z, self.used, self.harmonics.order(), self.bands, cells] {
            bytes.extend((number as u64).to_le_bytes());
        }
        [photons, flights, u64::from(most_scatterings)].iter().for_each(|number| bytes.extend(number.to_le_bytes()));
        let reals = self.edges.to_array().into_iter().chain([noise, beyond, cut]);
        reals.for_each(|number| bytes.extend(number.to_le_bytes()));
        self.slots.iter().for_each(|slot| bytes.extend(slot.to_le_bytes()));
        self.coefficients.iter().for_each(|number| bytes.extend(number.to_le_bytes()));
        self.bounds.iter().flatten().for_each(|number| bytes.extend(number.to_le_bytes()));
        let hash = fnv(&bytes);
        bytes.extend(hash.to_le_bytes());
        bytes
    }

    /// From bytes; nothing if they are no whole field.
    #[must_use]
    pub fn from_bytes(bytes: &[u8]) -> Option<Field> {
        let (body, end) = bytes.split_last_chunk::<8>()?;
        if fnv(body) != u64::from_le_bytes(*end) {
            return None;
        }
        let mut rest = body.strip_prefix(MAGIC)?;
        let mut number = || {
            let (first, behind) = rest.split_first_chunk::<8>()?;
            rest = behind;
            Some(*first)
        };
        let mut whole = || number().map(u64::from_le_bytes);
        let mut wholes = [0u64; 10];
        for slot in &mut wholes {
            *slot = whole()?;
        }
        let mut reals = [0.0; 6];
        for slot in &mut reals {
            *slot = f64::from_le_bytes(number()?);
        }
        let [x, y, z, used, order, bands, cells, photons, flights, most_scatterings] = wholes;
        let within = |number: u64, most: usize| usize::try_from(number).ok().filter(|number| *number <= most);
        let size = [within(x, MOST_CELLS)?, within(y, MOST_CELLS)?, within(z, MOST_CELLS)?];
        let count = size.iter().product();
        let (used, bands) = (within(used, count)?, within(bands, MOST_BANDS)?);
        let harmonics = Harmonics::new(within(order, HIGHEST)?);
        let groups = bands.div_ceil(LANES);
        let sums = used.checked_mul(groups * harmonics.count() * LANES)?;
        let words = count.checked_add(sums)?.checked_add(groups * LANES)?;
        if count == 0 || Some(rest.len()) != words.checked_mul(4) || reals.iter().any(|number| !number.is_finite()) {
            return None;
        }
        let mut words = rest.as_chunks::<4>().0.iter().copied();
        let slots: Vec<u32> = words.by_ref().take(count).map(u32::from_le_bytes).collect();
        let coefficients: Vec<f32> = words.by_ref().take(sums).map(f32::from_le_bytes).collect();
        let bounds: Vec<f32> = words.map(f32::from_le_bytes).collect();
        let sound = slots.iter().all(|slot| *slot == NONE || (*slot as usize) < used)
            && coefficients.iter().chain(&bounds).all(|number| number.is_finite());
        let [ex, ey, ez, noise, beyond, cut] = reals;
        sound.then(|| Field {
            size,
            edges: DVec3::new(ex, ey, ez),
            slots,
            used,
            harmonics,
            bands,
            coefficients,
            bounds: bounds.as_chunks::<LANES>().0.to_vec(),
            told: Told {
                photons,
                flights,
                most_scatterings: u32::try_from(most_scatterings).unwrap_or(u32::MAX),
                cells: cells as usize,
                noise,
                beyond,
                cut,
            },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::dust::multiple::{Settings, gather};
    use crate::physics::dust::phase::HenyeyGreenstein;
    use crate::physics::dust::scene::{Dust, Scene, Star};
    use crate::physics::dust::volume::Volume;

    #[test]
    fn a_field_comes_back_bit_for_bit_and_torn_ones_do_not() {
        let density = (0..8 * 6 * 4).map(|i| if i % 5 == 0 { 0.0 } else { 1.0 + (i % 7) as f32 }).collect();
        let volume = Volume::new([8, 6, 4], DVec3::new(2.0, 1.5, 1.0), density).unwrap();
        let dust =
            Dust { extinction: vec![1.0, 2.0, 3.0, 4.0, 5.0], albedo: 0.6, phase: HenyeyGreenstein::new(0.5).unwrap() };
        let scene = Scene::new(dust, vec![Star { position: DVec3::splat(0.1), intensity: vec![1.0; 5] }]).unwrap();
        let settings = Settings { cells: 4, order: 2, flights: 2000, ..Settings::fitting(&volume) };
        let field = gather(&volume, &scene, &settings).unwrap();
        let bytes = field.to_bytes();
        let back = Field::from_bytes(&bytes).unwrap();
        assert_eq!((&back.slots, &back.coefficients, &back.bounds), (&field.slots, &field.coefficients, &field.bounds));
        assert_eq!((back.size, back.edges, back.told, back.bands), (field.size, field.edges, field.told, field.bands));
        assert_eq!(back.to_bytes(), bytes);
        for at in (0..bytes.len()).step_by(97) {
            let mut other = bytes.clone();
            other[at] ^= 0x10;
            assert!(Field::from_bytes(&other).is_none() && Field::from_bytes(&bytes[..at]).is_none(), "byte {at}");
        }
    }

    #[test]
    fn numbers_that_ask_for_any_memory_are_refused() {
        // A right hash under lengths that cannot be.
        for at in 0..10 {
            let mut bytes = MAGIC.to_vec();
            (0..16).for_each(|i| bytes.extend(if i == at { u64::MAX } else { 1 }.to_le_bytes()));
            bytes.extend(fnv(&bytes).to_le_bytes());
            assert!(Field::from_bytes(&bytes).is_none());
        }
    }
}
