//! What a receiver at the wrong speed reads: characters as levels on a wire, sampled in the middle of the bits that the receiver
//! expects. 8 data bits, no parity, 1 stop bit.

/// What a receiver at `read` bits a second makes of characters that are sent, one right after the other, at `sent` bits a second:
/// each character with whether its stop bit was right. `phase` (0 to 1) is where in a sixteenth of a bit the receiver's clock
/// ticks: receivers look at the line 16 times a bit.
#[must_use]
pub fn misread(bytes: &[u8], sent: u32, read: u32, phase: f64) -> Vec<(u8, bool)> {
    let bit = f64::from(sent.max(1)) / f64::from(read.max(1));
    let look = bit / 16.0;
    let end = 10.0 * bytes.len() as f64;
    let mut characters = Vec::new();
    let mut t = look * phase.clamp(0.0, 1.0);
    while t < end {
        // Where the line falls, and is still low half a bit later, a character begins.
        if level(bytes, t) || level(bytes, t + 0.5 * bit) {
            t += look;
            continue;
        }
        let byte = (0..8).filter(|n| level(bytes, t + (1.5 + f64::from(*n)) * bit)).fold(0, |byte, n| byte | 1 << n);
        let stop = t + 9.5 * bit;
        let formed = level(bytes, stop);
        characters.push((byte, formed));
        // After a wrong stop bit the receiver waits until the line rests again.
        t = stop;
        while !level(bytes, t) {
            t += look;
        }
    }
    characters
}

/// The level of the line, in bits since the first start bit. It rests high.
fn level(bytes: &[u8], t: f64) -> bool {
    let slot = t.floor().max(0.0) as usize;
    match (bytes.get(slot / 10), slot % 10) {
        (None, _) | (_, 9) => true,
        (_, 0) => false,
        (Some(byte), bit) => byte >> (bit - 1) & 1 == 1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn at_the_right_speed_every_byte_is_read() {
        let all: Vec<u8> = (0..=255).collect();
        let read: Vec<u8> = misread(&all, 9600, 9600, 0.5).into_iter().map(|(byte, _)| byte).collect();
        assert_eq!(read, all);
        // Receivers bear 3 % each way.
        let read: Vec<u8> = misread(&all, 9600, 9800, 0.5).into_iter().map(|(byte, _)| byte).collect();
        assert_eq!(read, all);
    }

    /// Worked out by hand: `3F` is low, six high, two low. Twice as fast a receiver sees 0 0 111111 1111 (FE), then 0 000 1... (F8).
    #[test]
    fn twice_as_fast_a_receiver_reads_two_well_formed_bytes_that_are_wrong() {
        assert_eq!(misread(&[0x3F], 9600, 19200, 0.5), [(0xFE, true), (0xF8, true)]);
    }

    #[test]
    fn half_as_fast_a_receiver_always_finds_the_high_bits_set() {
        for byte in 0..=255 {
            for (read, _) in misread(&[byte], 9600, 4800, 0.3) {
                assert_eq!(read & 0xE0, 0xE0, "{byte:02X} read as {read:02X}");
            }
        }
    }
}
