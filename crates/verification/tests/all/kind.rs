//! Kinds of rows.

use carom_verification::{Counts, Kind};

#[test]
fn every_kind_has_its_own_place_and_name() {
    for (k, kind) in Kind::ALL.into_iter().enumerate() {
        assert_eq!(kind as usize, k);
        let same = Kind::ALL.iter().filter(|other| other.name() == kind.name());
        assert_eq!(same.count(), 1);
    }
}

#[test]
fn counts_name_the_kinds_that_there_are() {
    let mut counts = Counts::default();
    assert_eq!(counts.to_string(), "");
    for kind in [Kind::Regression, Kind::ClosedForm, Kind::ClosedForm] {
        counts.add(kind);
    }
    assert_eq!(counts.total(), 3);
    assert_eq!(counts.of(Kind::OtherCode), 0);
    assert_eq!(counts.to_string(), "2 closed form, 1 regression");
}
