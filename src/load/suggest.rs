//! "Did you mean …".

/// The candidate that a misspelt word most likely stands for, as the end of a message; nothing where none is near.
pub(super) fn did_you_mean<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> String {
    let nearness = |candidate: &&str| strsim::osa_distance(&word.to_lowercase(), &candidate.to_lowercase());
    let nearest = candidates.into_iter().min_by_key(nearness);
    match nearest {
        Some(candidate) if nearness(&candidate) <= 1 + candidate.chars().count() / 4 => {
            format!("; did you mean `{candidate}`?")
        }
        _ => String::new(),
    }
}

/// The words of a list as a message shows them.
pub(super) fn listed<'a>(words: impl IntoIterator<Item = &'a str>) -> String {
    words.into_iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_words_are_suggested_and_far_ones_are_not() {
        let keys = ["center", "radius", "material", "ior"];
        for (word, end) in [
            ("centre", "; did you mean `center`?"),
            ("raduis", "; did you mean `radius`?"),
            ("Material", "; did you mean `material`?"),
            ("iro", "; did you mean `ior`?"),
            ("banana", ""),
        ] {
            assert_eq!(did_you_mean(word, keys), end, "for {word}");
        }
    }
}
