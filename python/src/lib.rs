//! The compiled part of the Python package `carom`: thin functions over the crates of the workspace. What users see, with defaults and
//! documentation, is written in Python beside it (`python/carom`).

mod cases;
mod convert;
mod errors;
mod exact;
mod interface;
mod matrices;
mod schemes;
mod simulation;
mod watch;

use pyo3::prelude::*;

/// Fills the module.
#[pymodule]
fn _carom(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    module.add("CaseError", py.get_type::<errors::CaseError>())?;
    module.add("RunError", py.get_type::<errors::RunError>())?;
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<simulation::Simulation>()?;
    module.add_class::<simulation::Force>()?;
    module.add_class::<exact::Impact>()?;
    module.add_class::<matrices::MatrixRun>()?;
    module.add_function(wrap_pyfunction!(convert::read_toml, module)?)?;
    module.add_function(wrap_pyfunction!(convert::write_toml, module)?)?;
    module.add_function(wrap_pyfunction!(cases::read_file, module)?)?;
    module.add_function(wrap_pyfunction!(cases::schema, module)?)?;
    module.add_function(wrap_pyfunction!(cases::check, module)?)?;
    module.add_function(wrap_pyfunction!(cases::run, module)?)?;
    module.add_function(wrap_pyfunction!(cases::resume, module)?)?;
    module.add_function(wrap_pyfunction!(cases::compare, module)?)?;
    module.add_function(wrap_pyfunction!(cases::study, module)?)?;
    module.add_function(wrap_pyfunction!(cases::fit, module)?)?;
    module.add_function(wrap_pyfunction!(interface::solve_normal, module)?)?;
    module.add_function(wrap_pyfunction!(interface::solve_friction, module)?)?;
    module.add_function(wrap_pyfunction!(exact::hertz_collision, module)?)?;
    module.add_function(wrap_pyfunction!(exact::mass_on_bar, module)?)?;
    module.add_function(wrap_pyfunction!(exact::beam_on_stop, module)?)?;
    module.add_function(wrap_pyfunction!(schemes::scheme, module)?)?;
    module.add_function(wrap_pyfunction!(schemes::law, module)?)?;
    Ok(())
}
