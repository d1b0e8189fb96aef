//! The kernel with vectors of eight numbers: both corners along x in one, then two samples in one.

use std::arch::x86_64::{
    __m128, __m256, _mm_cvtss_f32, _mm_fmadd_ps, _mm_fnmadd_ps, _mm_mul_ps, _mm_set_epi64x, _mm_set1_ps, _mm_setr_ps,
    _mm_shuffle_ps, _mm_sub_ps, _mm256_castps256_ps128, _mm256_cvtph_ps, _mm256_extractf128_ps, _mm256_fmadd_ps,
    _mm256_fmsub_ps, _mm256_fnmadd_ps, _mm256_min_ps, _mm256_mul_ps, _mm256_permute2f128_ps, _mm256_set_m128,
    _mm256_set1_ps, _mm256_shuffle_ps, _mm256_sub_ps,
};

use super::{CELL, Cell, Cells, LANES, Places, Stretch, Traveller};

/// Takes a ray through a stretch, as [`super::through`] does; they differ by rounding.
#[inline]
#[target_feature(enable = "avx2,fma,f16c")]
pub(in super::super) fn through(
    cells: Cells<'_>,
    traveller: &mut Traveller,
    stretch: Stretch,
    extinction: [f32; CELL],
) {
    let (depth, thin) = stretch.depth(extinction);
    // Nearly all stretches are eight steps long: a count known beforehand is worth a third of the time.
    match (thin, stretch.steps == LANES) {
        (true, true) => samples::<true, true>(cells, traveller, stretch, depth),
        (true, false) => samples::<true, false>(cells, traveller, stretch, depth),
        (false, true) => samples::<false, true>(cells, traveller, stretch, depth),
        (false, false) => samples::<false, false>(cells, traveller, stretch, depth),
    }
}

#[inline]
#[target_feature(enable = "avx2,fma,f16c")]
fn samples<const THIN: bool, const EIGHT: bool>(
    cells: Cells<'_>,
    traveller: &mut Traveller,
    stretch: Stretch,
    depth: [f32; CELL],
) {
    let steps = if EIGHT { LANES } else { stretch.steps };
    let depth = _mm256_set_m128(four(depth), four(depth));
    let (mut light, mut left) = (four(traveller.light), four(traveller.through));
    for done in (0..steps).step_by(LANES) {
        let places = Places::of::<true>(cells, traveller, stretch, done);
        let now = (steps - done).min(LANES);
        for k in (0..now).step_by(2) {
            let alone = k + 1 >= now;
            let next = if alone { k } else { k + 1 };
            let (Some(a), Some(b)) = (rows(cells, &places, k), rows(cells, &places, next)) else { break };
            // From (near, far) of each sample to (first, second) of the near and of the far corners along x.
            let (near, far) = (_mm256_permute2f128_ps::<0x20>(a, b), _mm256_permute2f128_ps::<0x31>(a, b));
            let across = _mm256_set_m128(_mm_set1_ps(places.across[next]), _mm_set1_ps(places.across[k]));
            let met = _mm256_fmadd_ps(across, _mm256_sub_ps(far, near), near);
            let lost = lost::<THIN>(_mm256_mul_ps(depth, _mm256_shuffle_ps::<0xff>(met, met)));
            let gained = _mm256_mul_ps(lost, met);
            let (lost_first, lost_second) = (_mm256_castps256_ps128(lost), _mm256_extractf128_ps::<1>(lost));
            let (first, second) = (_mm256_castps256_ps128(gained), _mm256_extractf128_ps::<1>(gained));
            let past = _mm_sub_ps(_mm_set1_ps(1.0), lost_first);
            if alone {
                light = _mm_fmadd_ps(left, first, light);
                left = _mm_mul_ps(left, past);
            } else {
                light = _mm_fmadd_ps(left, _mm_fmadd_ps(past, second, first), light);
                left = _mm_mul_ps(left, _mm_fnmadd_ps(past, lost_second, past));
            }
        }
    }
    traveller.light = numbers(light);
    traveller.through = numbers(left);
}

/// The two corners along x of a sample, between its four rows.
#[inline]
#[target_feature(enable = "avx2,fma,f16c")]
fn rows(cells: Cells<'_>, places: &Places, k: usize) -> Option<__m256> {
    let (row, plane) = (cells.row as usize, cells.plane as usize);
    let [here, above, behind, both] = &places.shares;
    let at = places.base[k] as usize;
    // Two slices, so that four loads need two checks of their bounds.
    let front = cells.values.get(at..at + row + 2)?;
    let back = cells.values.get(at + plane..at + plane + row + 2)?;
    let sum = _mm256_mul_ps(pair(front)?, _mm256_set1_ps(here[k]));
    let sum = _mm256_fmadd_ps(pair(&front[row..])?, _mm256_set1_ps(above[k]), sum);
    let sum = _mm256_fmadd_ps(pair(back)?, _mm256_set1_ps(behind[k]), sum);
    Some(_mm256_fmadd_ps(pair(&back[row..])?, _mm256_set1_ps(both[k]), sum))
}

/// Two neighbouring cells: one load.
#[inline]
#[target_feature(enable = "avx2,fma,f16c")]
fn pair(cells: &[Cell]) -> Option<__m256> {
    let [a, b] = cells.first_chunk()?;
    Some(_mm256_cvtph_ps(_mm_set_epi64x(b.cast_signed(), a.cast_signed())))
}

/// 1 - e^-x, see [`super::lost`] and [`super::lost_thin`].
#[inline]
#[target_feature(enable = "avx2,fma,f16c")]
fn lost<const THIN: bool>(x: __m256) -> __m256 {
    let number = |value: f32| _mm256_set1_ps(value);
    if THIN {
        let inner = _mm256_fnmadd_ps(x, number(1.0 / 24.0), number(1.0 / 6.0));
        let series = _mm256_fmadd_ps(x, inner, number(-0.5));
        return _mm256_fmadd_ps(_mm256_mul_ps(x, x), series, x);
    }
    let y = _mm256_min_ps(_mm256_mul_ps(x, number(0.125)), number(2.0));
    let series = _mm256_fmadd_ps(y, number(1.0 / 120.0), number(-1.0 / 24.0));
    let series = _mm256_fmadd_ps(y, series, number(1.0 / 6.0));
    let series = _mm256_fmadd_ps(y, series, number(-0.5));
    let mut a = _mm256_mul_ps(y, _mm256_fmadd_ps(y, series, number(1.0)));
    for _ in 0..3 {
        a = _mm256_fmsub_ps(a, number(2.0), _mm256_mul_ps(a, a));
    }
    a
}

#[inline]
#[target_feature(enable = "avx2,fma,f16c")]
fn four([a, b, c, d]: [f32; CELL]) -> __m128 {
    _mm_setr_ps(a, b, c, d)
}

#[inline]
#[target_feature(enable = "avx2,fma,f16c")]
fn numbers(v: __m128) -> [f32; CELL] {
    let second = _mm_shuffle_ps::<1>(v, v);
    let (third, fourth) = (_mm_shuffle_ps::<2>(v, v), _mm_shuffle_ps::<3>(v, v));
    [_mm_cvtss_f32(v), _mm_cvtss_f32(second), _mm_cvtss_f32(third), _mm_cvtss_f32(fourth)]
}
