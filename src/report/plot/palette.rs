//! The few colours of plots: on white paper, and on a dark screen.
//!
//! Blue for the engine, darker for more lanes; vermilion for what it is held against; greys for all else. They differ in
//! lightness too, so that they can be told apart without seeing red or green, and in print without colour.

/// A colour, and the one that takes its place on a dark screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Colour {
    on_white: [u8; 3],
    on_dark: [u8; 3],
}

impl Colour {
    /// What is drawn on, where there is no page that has a colour.
    pub(crate) const PAPER: Self = Self { on_white: [0xff; 3], on_dark: [0x18, 0x1a, 0x1c] };
    /// Words and axes.
    pub(crate) const INK: Self = Self { on_white: [0x22, 0x26, 0x2a], on_dark: [0xe4, 0xe6, 0xe8] };
    /// What is said aside.
    pub(crate) const MUTED: Self = Self { on_white: [0x6a, 0x70, 0x76], on_dark: [0x9c, 0xa2, 0xa8] };
    /// Lines to read along.
    pub(crate) const GRID: Self = Self { on_white: [0xe2, 0xe5, 0xe8], on_dark: [0x34, 0x38, 0x3c] };
    /// The f64 reference.
    pub(crate) const TRUTH: Self = Self { on_white: [0x8a, 0x8f, 0x94], on_dark: [0x86, 0x8b, 0x90] };
    /// What a result is held against.
    pub(crate) const LIMIT: Self = Self { on_white: [0xc4, 0x4e, 0x12], on_dark: [0xf2, 0x8e, 0x5c] };
    /// The wavefront engine, by its lanes: 1, 4, 8, 16. Series of any kind may use them.
    pub(crate) const LANES: [Self; 4] = [
        Self { on_white: [0x9f, 0xc6, 0xe8], on_dark: [0x2f, 0x5d, 0x8c] },
        Self { on_white: [0x5d, 0x9c, 0xd3], on_dark: [0x4b, 0x86, 0xc0] },
        Self { on_white: [0x27, 0x6c, 0xad], on_dark: [0x7d, 0xb2, 0xe6] },
        Self { on_white: [0x12, 0x3c, 0x6b], on_dark: [0xc4, 0xdf, 0xf8] },
    ];

    fn all() -> impl Iterator<Item = Self> {
        let few = [Self::PAPER, Self::INK, Self::MUTED, Self::GRID, Self::TRUTH, Self::LIMIT];
        few.into_iter().chain(Self::LANES)
    }

    /// As it is drawn: red, green, blue.
    pub(super) fn on_white(self) -> [u8; 3] {
        self.on_white
    }
}

/// Rules that put the colours for a dark screen in the place of those that are drawn.
pub(crate) fn dark_style() -> String {
    let hex = |[red, green, blue]: [u8; 3]| format!("#{red:02X}{green:02X}{blue:02X}");
    let rule = |colour: Colour| {
        let (from, to) = (hex(colour.on_white), hex(colour.on_dark));
        format!("svg [fill=\"{from}\"] {{ fill: {to} }} svg [stroke=\"{from}\"] {{ stroke: {to} }}\n")
    };
    Colour::all().map(rule).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance after WCAG 2.1.
    fn luminance(colour: [u8; 3]) -> f64 {
        let linear = colour.map(|code| {
            let value = f64::from(code) / 255.0;
            if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
        });
        0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
    }

    fn contrast(a: [u8; 3], b: [u8; 3]) -> f64 {
        let (a, b) = (luminance(a) + 0.05, luminance(b) + 0.05);
        a.max(b) / a.min(b)
    }

    /// 4.5 : 1 is what WCAG 2.1 asks for words.
    #[test]
    fn words_can_be_read_on_either_background() {
        for colour in [Colour::INK, Colour::MUTED, Colour::LIMIT] {
            assert!(contrast(colour.on_white, Colour::PAPER.on_white) >= 4.5, "{colour:?}");
            assert!(contrast(colour.on_dark, Colour::PAPER.on_dark) >= 4.5, "{colour:?}");
        }
    }

    #[test]
    fn lanes_are_told_apart_by_lightness() {
        for pair in Colour::LANES.windows(2) {
            assert!(contrast(pair[0].on_white, pair[1].on_white) > 1.5, "{pair:?}");
            assert!(contrast(pair[0].on_dark, pair[1].on_dark) > 1.3, "{pair:?}");
        }
    }
}
