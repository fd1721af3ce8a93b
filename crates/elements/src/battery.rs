//! What every element kind must satisfy, checked over [`Kind::ALL`].
