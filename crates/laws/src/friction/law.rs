//! What a friction law is asked.

/// What a friction law must answer.
pub trait FrictionLaw {
    /// Name as in the case file.
    fn name(&self) -> &'static str;
    /// μ up to which a point sticks.
    fn sticks(&self) -> f64;
    /// μ of a point that slides, at most [`FrictionLaw::sticks`]. `rate`: how fast it slides at the start of the step, m/s.
    fn slides(&self, rate: f64) -> f64;
}
