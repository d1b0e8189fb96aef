//! What the buttons of presenters, gamepads and keyboards stand for: the keys of a hand controller.
//!
//! Numbers: Linux, include/uapi/linux/input-event-codes.h.

/// Button codes and the key each stands for.
const NAMES: &[(&[u16], &str)] = &[
    // Blank screen (B or .) of a presenter; the question mark's key; X and Y, SELECT.
    (&[48, 52, 53, 307, 308, 314], "?"),
    // Escape, backspace; B (east), START.
    (&[1, 14, 305, 315], "MODE"),
    // Return, F5 (begin the show), space; A (south), the left mouse button of presenters with a pad.
    (&[28, 96, 63, 57, 304, 272], "ENTER"),
    // Arrow up and left, page up, volume up; shoulder left, pad up and left.
    (&[103, 105, 104, 115, 310, 544, 546], "UP"),
    // Arrow down and right, page down, volume down; shoulder right, pad down and right.
    (&[108, 106, 109, 114, 311, 545, 547], "DOWN"),
    (&[11, 82], "0"),
    (&[2, 79], "1"),
    (&[3, 80], "2"),
    (&[4, 81], "3"),
    (&[5, 75], "4"),
    (&[6, 76], "5"),
    (&[7, 77], "6"),
    (&[8, 71], "7"),
    (&[9, 72], "8"),
    (&[10, 73], "9"),
];

/// The key that a button stands for.
#[must_use]
pub fn of_button(code: u16) -> Option<&'static str> {
    NAMES.iter().find(|(codes, _)| codes.contains(&code)).map(|(_, name)| *name)
}

/// The key that a gamepad's pad stands for, pushed up or left (negative) or down or right.
#[must_use]
pub fn of_pad(value: i32) -> Option<&'static str> {
    match value.signum() {
        -1 => Some("UP"),
        1 => Some("DOWN"),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_button_stands_for_two_keys() {
        let mut all: Vec<u16> = NAMES.iter().flat_map(|(codes, _)| codes.iter().copied()).collect();
        let count = all.len();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), count);
    }

    #[test]
    fn the_buttons_of_a_presenter_are_known() {
        use evdev::KeyCode;
        assert_eq!(of_button(KeyCode::KEY_PAGEDOWN.0), Some("DOWN"));
        assert_eq!(of_button(KeyCode::KEY_PAGEUP.0), Some("UP"));
        assert_eq!(of_button(KeyCode::KEY_DOT.0), Some("?"));
        assert_eq!(of_button(KeyCode::KEY_F5.0), Some("ENTER"));
        assert_eq!(of_button(KeyCode::BTN_SOUTH.0), Some("ENTER"));
        assert_eq!(of_button(KeyCode::BTN_DPAD_DOWN.0), Some("DOWN"));
        assert_eq!(of_button(KeyCode::KEY_A.0), None);
    }
}
