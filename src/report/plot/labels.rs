//! Where the labels of points go, so that none covers another, a mark, or the frame.

/// A rectangle of pixels, y downwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Area {
    pub(super) left: i32,
    pub(super) top: i32,
    pub(super) right: i32,
    pub(super) bottom: i32,
}

/// A label's place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place {
    pub(super) area: Area,
    /// Whether it is so far off its mark that a line should lead there.
    pub(super) needs_line: bool,
}

/// Height of a line of words, pixels.
pub(super) const LINE: i32 = 15;

/// Roughly how wide words are in the plots' type: fonts differ, so rather too much.
pub(super) fn text_width(text: &str) -> i32 {
    let characters = i32::try_from(text.chars().count()).unwrap_or(i32::MAX / 32);
    characters * 15 / 2 + 2
}

impl Area {
    /// Around a point, as far as `reach` to every side.
    pub(super) fn around((x, y): (i32, i32), reach: i32) -> Self {
        Self { left: x - reach, top: y - reach, right: x + reach, bottom: y + reach }
    }

    pub(super) fn overlaps(&self, other: &Self) -> bool {
        self.left < other.right
            && other.left < self.right
            && self.top < other.bottom
            && other.top < self.bottom
    }

    fn holds(&self, other: &Self) -> bool {
        self.left <= other.left
            && self.top <= other.top
            && other.right <= self.right
            && other.bottom <= self.bottom
    }
}

/// Finds a place for each label beside its mark: right or left of it, and as little above or below as the others allow.
/// A label for which there is no place within the frame stays right of its mark. Marks without a label take room too.
pub(super) fn place(
    marks: &[(i32, i32)],
    without_label: &[(i32, i32)],
    labels: &[String],
    frame: &Area,
) -> Vec<Place> {
    let all_marks = marks.iter().chain(without_label);
    let mut taken: Vec<Area> = all_marks.map(|&mark| Area::around(mark, 5)).collect();
    let mut places = vec![None; marks.len()];
    // From the top down, so that those which have to move away keep the order of their marks.
    let mut order: Vec<usize> = (0..marks.len()).collect();
    order.sort_by_key(|&index| (marks[index].1, marks[index].0));
    for index in order {
        let place = nearest_free(marks[index], text_width(&labels[index]), &taken, frame);
        taken.push(place.area);
        places[index] = Some(place);
    }
    places.into_iter().flatten().collect()
}

fn nearest_free((x, y): (i32, i32), width: i32, taken: &[Area], frame: &Area) -> Place {
    const GAP: i32 = 9;
    const STEP: i32 = 3;
    let furthest = (frame.bottom - frame.top) / STEP;
    // Beside a mark without a line, a little nearer to it than with one.
    let candidate = |side: i32, steps: i32| {
        let needs_line = steps.abs() * STEP > LINE / 3;
        let gap = if needs_line { 2 * GAP } else { GAP };
        let left = if side > 0 { x + gap } else { x - gap - width };
        let top = y + steps * STEP - LINE / 2;
        Place { area: Area { left, top, right: left + width, bottom: top + LINE }, needs_line }
    };
    // Going left costs as much as going up or down by two lines.
    let cost = |side: i32, steps: i32| steps.abs() * STEP + if side > 0 { 0 } else { 2 * LINE };
    let mut candidates: Vec<(i32, i32)> =
        (-furthest..=furthest).flat_map(|steps| [(1, steps), (-1, steps)]).collect();
    candidates.sort_by_key(|&(side, steps)| cost(side, steps));
    let is_free =
        |place: &Place| frame.holds(&place.area) && !taken.iter().any(|other| other.overlaps(&place.area));
    let free = candidates.into_iter().map(|(side, steps)| candidate(side, steps)).find(is_free);
    free.unwrap_or_else(|| candidate(1, 0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const FRAME: Area = Area { left: 0, top: 0, right: 600, bottom: 400 };

    #[test]
    fn a_label_with_room_stands_right_of_its_mark() {
        let places = place(&[(100, 100)], &[], &["one".into()], &FRAME);
        assert!(places[0].area.left > 100 && !places[0].needs_line, "{places:?}");
        assert_eq!((places[0].area.top + places[0].area.bottom) / 2, 100);
    }

    #[test]
    fn at_the_right_edge_it_stands_left() {
        let places = place(&[(590, 100)], &[], &["one".into()], &FRAME);
        assert!(places[0].area.right < 590, "{places:?}");
    }

    proptest! {
        /// Eight labels anywhere, even all at one point, have room in this frame.
        #[test]
        fn labels_cover_neither_each_other_nor_a_mark(
            marks in prop::collection::vec((150..450, 100..300), 1..8)
        ) {
            let labels: Vec<String> = (0..marks.len()).map(|index| format!("label {index}")).collect();
            let places = place(&marks, &[], &labels, &FRAME);
            for (index, place) in places.iter().enumerate() {
                prop_assert!(FRAME.holds(&place.area));
                for other in &places[..index] {
                    prop_assert!(!place.area.overlaps(&other.area), "{places:?}");
                }
                prop_assert!(!marks.iter().any(|&mark| Area::around(mark, 5).overlaps(&place.area)), "{places:?}");
            }
        }
    }
}
