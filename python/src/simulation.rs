//! A run whose steps are taken from Python.

#![expect(
    unsafe_code,
    reason = "NumPy looks at memory of the simulation without a copy"
)]

use std::path::PathBuf;
use std::sync::Mutex;

use carom_case::{AddedForce, Built, build_with};
use carom_dynamics::{Held, Order, Stepper};
use carom_laws::Status;
use numpy::ndarray::{ArrayView1, ArrayView2};
use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::cases::{Given, Loaded, load};
use crate::errors::{failed, refused};

/// A force that is set between the steps.
#[pyclass(frozen, module = "carom")]
pub(crate) struct Force(Held);

#[pymethods]
impl Force {
    /// Size of the force in the steps to come, N.
    #[getter]
    fn value(&self) -> f64 {
        self.0.get()
    }

    fn __repr__(&self) -> String {
        format!("<carom.Force of {} N>", self.0.get())
    }

    #[setter]
    fn set_value(&self, value: f64) -> PyResult<()> {
        set(&self.0, value)
    }
}

fn set(held: &Held, value: f64) -> PyResult<()> {
    if !value.is_finite() {
        let message = format!("a force of {value} N; accepted: a finite number");
        return Err(PyValueError::new_err(message));
    }
    held.set(value);
    Ok(())
}

/// Numbers at nodes or contact points that Python looks at.
#[derive(Clone, Copy)]
enum Seen {
    Displacement,
    Velocity,
    Acceleration,
    Force,
    Gap,
    Rate,
    Pressure,
}

/// Memory that views of Python are on: made when first asked for, never moved while the simulation lives, and written after each step.
#[derive(Default)]
struct Memory {
    numbers: [Option<Box<[f64]>>; 7],
    closed: Option<Box<[bool]>>,
}

impl Memory {
    fn renew(&mut self, run: &dyn Stepper) {
        let all = [
            Seen::Displacement,
            Seen::Velocity,
            Seen::Acceleration,
            Seen::Force,
            Seen::Gap,
            Seen::Rate,
            Seen::Pressure,
        ];
        for seen in all {
            if let Some(numbers) = &mut self.numbers[seen as usize] {
                write(run, seen, numbers);
            }
        }
        if let Some(closed) = &mut self.closed {
            let statuses = &run.state().interface.status;
            for (closed, status) in closed.iter_mut().zip(statuses) {
                *closed = *status != Status::Open;
            }
        }
    }
}

/// Writes what is seen: of nodes three components each, in the order of the mesh.
fn write(run: &dyn Stepper, seen: Seen, out: &mut [f64]) {
    let (system, state) = (run.system(), run.state());
    let interface = &state.interface;
    let order = match seen {
        Seen::Displacement => Order::Displacement,
        Seen::Velocity => Order::Velocity,
        Seen::Acceleration => Order::Acceleration,
        Seen::Force => return out.copy_from_slice(&interface.force),
        Seen::Gap => return out.copy_from_slice(&interface.gap),
        Seen::Rate => return out.copy_from_slice(&interface.rate),
        Seen::Pressure => {
            for (point, pressure) in out.iter_mut().enumerate() {
                let (contact, place) = system.point(point);
                let (force, area) = (interface.force[point], contact.points[place].area);
                *pressure = if force == 0.0 { 0.0 } else { force / area };
            }
            return;
        }
    };
    for (own, &node) in system.mesh_node.iter().enumerate() {
        let place = 3 * node as usize;
        if let Some(out) = out.get_mut(place..place + 3) {
            out.copy_from_slice(&system.of_node(own as u32, &state.motion, order));
        }
    }
}

/// A case between two steps.
#[pyclass(module = "carom")]
pub(crate) struct Simulation {
    loaded: Option<Loaded>,
    folder: Option<PathBuf>,
    /// Whether there is a results folder, which is complete once the end is reached.
    writes: bool,
    forces: Vec<AddedForce>,
    /// Functions of the simulation that give the size of a force before each step.
    controls: Vec<(Held, Py<PyAny>)>,
    /// Never shared: what writes its results is not for several threads.
    run: Option<Mutex<carom_case::Simulation>>,
    memory: Memory,
    summary: Option<String>,
    ended: bool,
}

impl Simulation {
    /// The run, which begins when first asked for.
    fn begun(&mut self, py: Python<'_>) -> PyResult<&mut carom_case::Simulation> {
        if let Some(loaded) = self.loaded.take() {
            let (forces, folder) = (&self.forces, self.folder.take());
            let begun = py.detach(|| {
                let parts = (&loaded.input, &loaded.case, loaded.built);
                carom_case::Simulation::new(parts, forces, folder)
            });
            self.run = Some(Mutex::new(begun.map_err(|error| failed(&error))?));
        }
        own(&mut self.run).ok_or_else(|| PyRuntimeError::new_err("the simulation could not begin"))
    }

    /// The case as built. Asking for it does not begin the run, so that forces can still be added.
    fn built(&mut self) -> PyResult<&Built> {
        match (&self.loaded, own(&mut self.run)) {
            (Some(loaded), _) => Ok(&loaded.built),
            (None, Some(run)) => Ok(run.built()),
            (None, None) => Err(PyRuntimeError::new_err("the simulation could not begin")),
        }
    }

    fn take_step(&mut self, py: Python<'_>) -> PyResult<()> {
        if self.ended {
            return Err(PyRuntimeError::new_err("the simulation has ended"));
        }
        self.begun(py)?;
        let Some(run) = own(&mut self.run) else {
            return Ok(());
        };
        // steps of small models are shorter than giving up the lock of Python
        let stepped = match run.run().system().unknowns() > 2000 {
            true => py.detach(|| run.step()),
            false => run.step(),
        };
        match stepped {
            Ok(()) => {
                self.memory.renew(run.run());
                Ok(())
            }
            Err(error) => {
                self.ended = true;
                match py.detach(|| run.finish(Some(error))) {
                    Err(error) => Err(failed(&error)),
                    Ok(_) => Err(PyRuntimeError::new_err("a failed step has no error")),
                }
            }
        }
    }

    fn end(&mut self, py: Python<'_>) -> PyResult<()> {
        if self.ended {
            return Ok(());
        }
        self.begun(py)?;
        self.ended = true;
        let Some(run) = own(&mut self.run) else {
            return Ok(());
        };
        let finished = py.detach(|| run.finish(None));
        if let Some(finished) = finished.map_err(|error| failed(&error))? {
            let json = finished.summary.to_json();
            self.summary = Some(json.map_err(|error| failed(&error))?);
        }
        Ok(())
    }

    fn view<'py>(slf: &Bound<'py, Self>, seen: Seen, width: usize) -> PyResult<Bound<'py, PyAny>> {
        let py = slf.py();
        let mut this = slf.borrow_mut();
        let run = this.begun(py)?.run();
        let system = run.system();
        let rows = match width {
            1 => system.points(),
            _ => system.mesh.nodes.len(),
        };
        if this.memory.numbers[seen as usize].is_none() {
            let mut numbers = vec![0.0; rows * width].into_boxed_slice();
            write(this.begun(py)?.run(), seen, &mut numbers);
            this.memory.numbers[seen as usize] = Some(numbers);
        }
        let Some(numbers) = &this.memory.numbers[seen as usize] else {
            return Err(PyRuntimeError::new_err("no memory for a view"));
        };
        let owner = slf.clone().into_any();
        // SAFETY: the memory is that of a box which the simulation neither moves nor frees while it lives, and the array holds the
        // simulation. It is written with the lock of Python held, by `renew`.
        let array = unsafe {
            match width {
                1 => {
                    let view = ArrayView1::from(&numbers[..]);
                    PyArray1::borrow_from_array(&view, owner).into_any()
                }
                _ => {
                    let view = ArrayView2::from_shape((rows, width), &numbers[..]);
                    let view = view.map_err(|e| PyRuntimeError::new_err(e.to_string()))?;
                    PyArray2::borrow_from_array(&view, owner).into_any()
                }
            }
        };
        read_only(array)
    }
}

fn read_only(array: Bound<'_, PyAny>) -> PyResult<Bound<'_, PyAny>> {
    array.getattr("flags")?.setattr("writeable", false)?;
    Ok(array)
}

fn own(run: &mut Option<Mutex<carom_case::Simulation>>) -> Option<&mut carom_case::Simulation> {
    let run = run.as_mut()?;
    Some(
        run.get_mut()
            .unwrap_or_else(|poisoned| poisoned.into_inner()),
    )
}

#[pymethods]
impl Simulation {
    #[new]
    fn new(py: Python<'_>, given: Given, folder: Option<PathBuf>) -> PyResult<Simulation> {
        Ok(Simulation {
            loaded: Some(load(py, given)?),
            writes: folder.is_some(),
            folder,
            forces: Vec::new(),
            controls: Vec::new(),
            run: None,
            memory: Memory::default(),
            summary: None,
            ended: false,
        })
    }

    /// Adds a force before the first step; `size`: a number, a function of the simulation, or nothing yet.
    fn add_force(
        &mut self,
        py: Python<'_>,
        on: String,
        direction: Vec<f64>,
        size: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Force> {
        let Some(loaded) = &mut self.loaded else {
            let message = "forces are added before the first step and the first view";
            return Err(PyRuntimeError::new_err(message));
        };
        let held = Held::new();
        let mut control = None;
        match size {
            Some(size) if size.is_callable() => control = Some(size.unbind()),
            Some(size) => set(&held, size.extract()?)?,
            None => {}
        }
        let mut forces = self.forces.clone();
        forces.push(AddedForce {
            name: format!("{} on {on}", forces.len() + 1),
            on,
            direction,
            size: held.clone(),
        });
        let built = py.detach(|| build_with(&loaded.case, &loaded.locator, &loaded.input, &forces));
        loaded.built = built.map_err(|problems| refused(py, &loaded.input.sources, &problems))?;
        self.forces = forces;
        self.controls
            .extend(control.map(|control| (held.clone(), control)));
        Ok(Force(held))
    }

    fn __iter__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __next__(slf: &Bound<'_, Self>) -> PyResult<Option<Py<Self>>> {
        if slf.borrow().ended {
            return Ok(None);
        }
        if slf.borrow_mut().begun(slf.py())?.is_done() {
            let mut this = slf.borrow_mut();
            if this.writes {
                this.end(slf.py())?;
            }
            return Ok(None);
        }
        Simulation::step(slf)?;
        Ok(Some(slf.clone().unbind()))
    }

    /// Takes one step. An exception of a control ends the run first.
    fn step(slf: &Bound<'_, Self>) -> PyResult<()> {
        let py = slf.py();
        let count = slf.borrow().controls.len();
        for k in 0..count {
            let (held, control) = {
                let this = slf.borrow();
                let (held, control) = &this.controls[k];
                (held.clone(), control.clone_ref(py))
            };
            let size = control.call1(py, (slf,)).and_then(|size| size.extract(py));
            if let Err(error) = size.and_then(|size| set(&held, size)) {
                slf.borrow_mut().end(py)?;
                return Err(error);
            }
        }
        slf.borrow_mut().take_step(py)
    }

    /// Ends the run and writes what stands in its folder.
    fn finish(&mut self, py: Python<'_>) -> PyResult<()> {
        self.end(py)
    }

    /// Summary of the finished run as JSON, of one with a folder.
    #[getter]
    fn summary_json(&self) -> Option<&str> {
        self.summary.as_deref()
    }

    #[getter]
    fn ended(&self) -> bool {
        self.ended
    }

    #[getter]
    fn time(&mut self, py: Python<'_>) -> PyResult<f64> {
        match self.loaded {
            Some(_) => Ok(0.0),
            None => Ok(self.begun(py)?.run().state().time),
        }
    }

    #[getter]
    fn steps(&mut self, py: Python<'_>) -> PyResult<u64> {
        match self.loaded {
            Some(_) => Ok(0),
            None => Ok(self.begun(py)?.run().state().step),
        }
    }

    #[getter]
    fn end_time(&mut self) -> PyResult<f64> {
        Ok(self.built()?.end)
    }

    #[getter]
    fn dt(&mut self) -> PyResult<f64> {
        Ok(self.built()?.system.dt)
    }

    #[getter]
    fn done(&mut self, py: Python<'_>) -> PyResult<bool> {
        Ok(self.begun(py)?.is_done())
    }

    #[getter]
    fn dimension(&mut self) -> PyResult<usize> {
        Ok(self.built()?.system.dim)
    }

    /// Forces of the contacts in the last step, N, by name.
    #[getter]
    fn contact_forces(&mut self, py: Python<'_>) -> PyResult<Vec<(String, f64)>> {
        let run = self.begun(py)?.run();
        let names = run.system().contacts.iter().map(|c| c.name.clone());
        let forces = run.report().contacts.iter().map(|contact| contact.force);
        Ok(names.zip(forces).collect())
    }

    /// First and last contact point of each contact, by name.
    #[getter]
    fn contact_points(&mut self, py: Python<'_>) -> PyResult<Vec<(String, usize, usize)>> {
        let system = self.begun(py)?.run().system();
        let contacts = system.contacts.iter().enumerate();
        let points = contacts.map(|(k, contact)| {
            let points = system.points_of(k);
            (contact.name.clone(), points.start, points.end)
        });
        Ok(points.collect())
    }

    /// Energy residual and largest energy since the start, J.
    #[getter]
    fn energy(&mut self, py: Python<'_>) -> PyResult<(f64, f64)> {
        let ledger = &self.begun(py)?.run().state().ledger;
        Ok((ledger.balance.energy_residual, ledger.largest_energy))
    }

    /// Nodes of a group of the mesh, from 0.
    fn nodes(&mut self, group: &str) -> PyResult<Vec<u32>> {
        let mesh = &self.built()?.system.mesh;
        match mesh.groups.get(group) {
            Some(group) => Ok(mesh.group_nodes(group)),
            None => {
                let names: Vec<&str> = mesh.groups.keys().map(String::as_str).collect();
                let message = format!(
                    "no group `{group}` in the mesh; accepted: {}",
                    names.join(", ")
                );
                Err(PyValueError::new_err(message))
            }
        }
    }

    /// Places of the nodes of the mesh, m.
    #[getter]
    fn places(&mut self) -> PyResult<Vec<[f64; 3]>> {
        Ok(self.built()?.system.mesh.nodes.clone())
    }

    #[getter]
    fn displacement<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        Simulation::view(slf, Seen::Displacement, 3)
    }

    #[getter]
    fn velocity<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        Simulation::view(slf, Seen::Velocity, 3)
    }

    #[getter]
    fn acceleration<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        Simulation::view(slf, Seen::Acceleration, 3)
    }

    #[getter]
    fn force<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        Simulation::view(slf, Seen::Force, 1)
    }

    #[getter]
    fn gap<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        Simulation::view(slf, Seen::Gap, 1)
    }

    #[getter]
    fn gap_rate<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        Simulation::view(slf, Seen::Rate, 1)
    }

    #[getter]
    fn pressure<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        Simulation::view(slf, Seen::Pressure, 1)
    }

    #[getter]
    fn closed<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let py = slf.py();
        let mut this = slf.borrow_mut();
        if this.memory.closed.is_none() {
            let statuses = &this.begun(py)?.run().state().interface.status;
            let closed: Vec<bool> = statuses.iter().map(|s| *s != Status::Open).collect();
            this.memory.closed = Some(closed.into_boxed_slice());
        }
        let Some(closed) = &this.memory.closed else {
            return Err(PyRuntimeError::new_err("no memory for a view"));
        };
        let view = ArrayView1::from(&closed[..]);
        // SAFETY: as in `view`.
        let array = unsafe { PyArray1::borrow_from_array(&view, slf.clone().into_any()) };
        read_only(array.into_any())
    }

    /// Everything that the run goes on from.
    fn save<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let saved = self.begun(py)?.saved().map_err(|error| failed(&error))?;
        Ok(PyBytes::new(py, &saved))
    }

    /// Goes on from what was saved.
    fn restore(&mut self, py: Python<'_>, saved: &[u8]) -> PyResult<()> {
        let restored = self.begun(py)?.restore(saved);
        restored.map_err(|error| failed(&error))?;
        self.ended = false;
        if let Some(run) = own(&mut self.run) {
            self.memory.renew(run.run());
        }
        Ok(())
    }
}
