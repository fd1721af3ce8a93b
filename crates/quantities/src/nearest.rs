//! The name that was meant.

/// The name nearest to `found`, when it is near enough to be what was meant: at most one third of its letters differ (one of two or three).
pub fn nearest<'a>(found: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let lower = found.to_lowercase();
    names
        .into_iter()
        .map(|name| {
            (
                strsim::damerau_levenshtein(&lower, &name.to_lowercase()),
                name,
            )
        })
        .filter(|&(edits, name)| {
            let letters = found.chars().count().max(name.chars().count());
            edits <= (letters / 3).max(1) && edits < name.chars().count()
        })
        .min_by_key(|&(edits, name)| (edits, name != found, name))
        .map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_name_is_given_only_when_it_may_be_meant() {
        let names = ["density", "elastic", "young"];
        assert_eq!(nearest("densty", names), Some("density"));
        assert_eq!(nearest("Density", names), Some("density"));
        assert_eq!(nearest("yuong", names), Some("young"));
        assert_eq!(nearest("colour", names), None);
        assert_eq!(nearest("x", ["y"]), None);
        assert_eq!(nearest("anything", []), None);
    }
}
