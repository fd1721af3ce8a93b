//! Vectors and matrices of three components, for kernels.
//!
//! Stored arrays and public signatures use `[f64; 3]`; a kernel converts with `Vec3::from` and back with `Into`. Nothing here
//! is dynamic: sparse and dense systems of any size have their own modules.

/// Vector of three components.
pub type Vec3 = nalgebra::Vector3<f64>;

/// Matrix of three rows and three columns, stored by columns.
pub type Mat3 = nalgebra::Matrix3<f64>;
