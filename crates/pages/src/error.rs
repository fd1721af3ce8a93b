//! Why a figure or a page could not be made.

/// Why a figure or a page could not be made. Each variant names the datum and the cause.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A page could not be compressed, which would be a fault of the program.
    #[error("cannot compress the data of a page: {cause}")]
    Compression {
        /// The cause.
        cause: String,
    },
    /// A curve holds a value that cannot be drawn.
    #[error("curve '{curve}': the {axis} of sample {index} is {value}")]
    NotFinite {
        /// Name of the curve.
        curve: String,
        /// `abscissa` or `ordinate`.
        axis: &'static str,
        /// Number of the sample, counted from zero.
        index: usize,
        /// The value: NaN or an infinity.
        value: f64,
    },
    /// The abscissae of a curve go backwards.
    #[error("curve '{curve}': sample {index} goes back to {value}")]
    Backwards {
        /// Name of the curve.
        curve: String,
        /// Number of the sample, counted from zero.
        index: usize,
        /// Its abscissa.
        value: f64,
    },
    /// A curve with more abscissae than ordinates, or the reverse.
    #[error("curve '{curve}' has {x} abscissae and {y} ordinates")]
    CurveLength {
        /// Name of the curve.
        curve: String,
        /// Number of abscissae.
        x: usize,
        /// Number of ordinates.
        y: usize,
    },
    /// A panel without a single sample.
    #[error("nothing to draw in panel '{panel}'")]
    EmptyPanel {
        /// Title of the panel.
        panel: String,
    },
    /// The drawing library failed.
    #[error("cannot draw figure '{figure}': {cause}")]
    Drawing {
        /// Title of the figure.
        figure: String,
        /// What it said.
        cause: String,
    },
    /// The head of a page could not be put into JSON.
    #[error("page: {0}")]
    Json(#[from] serde_json::Error),
}
