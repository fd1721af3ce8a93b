//! Solves with PETSc (Balay et al., PETSc/TAO Users Manual). Nothing names it but this and `scotch`.
//!
//! Conjugate gradients with the blocks of nodes as preconditioner, or what `PETSC_OPTIONS` says: `-pc_type gamg` is algebraic multigrid
//! with the rigid motions of the nodes, `-pc_type cholesky -pc_factor_mat_solver_type mumps` a factor over all ranks.

#![allow(
    unsafe_code,
    reason = "functions of a C library; each call passes pointers that live as long as it does"
)]

use std::ffi::{CStr, c_char, c_int, c_void};
use std::ptr::null_mut;

use mpi::ffi::MPI_Comm;

use carom_ranks::{Engine, OwnRows, Ranks, Unsolved};

pub(crate) type Handle = *mut c_void;
pub(crate) type Code = c_int;

unsafe extern "C" {
    pub(crate) static PETSC_COMM_WORLD: MPI_Comm;
    fn PetscOptionsSetValue(options: Handle, name: *const c_char, value: *const c_char) -> Code;
    fn PetscInitializeNoArguments() -> Code;
    fn PetscFinalize() -> Code;
    fn PetscPushErrorHandler(handler: Handle, context: Handle) -> Code;
    fn PetscReturnErrorHandler();
    fn PetscErrorMessage(code: c_int, text: *mut *const c_char, specific: *mut *mut c_char)
    -> Code;
    fn MatCreate(comm: MPI_Comm, matrix: *mut Handle) -> Code;
    fn MatSetSizes(matrix: Handle, m: c_int, n: c_int, rows: c_int, columns: c_int) -> Code;
    fn MatSetType(matrix: Handle, kind: *const c_char) -> Code;
    fn MatSetBlockSize(matrix: Handle, size: c_int) -> Code;
    fn MatMPIAIJSetPreallocationCSR(
        matrix: Handle,
        offsets: *const c_int,
        columns: *const c_int,
        values: *const f64,
    ) -> Code;
    fn MatSetOption(matrix: Handle, option: c_int, value: c_int) -> Code;
    fn MatSetNearNullSpace(matrix: Handle, space: Handle) -> Code;
    fn MatNullSpaceCreateRigidBody(places: Handle, space: *mut Handle) -> Code;
    fn MatNullSpaceDestroy(space: *mut Handle) -> Code;
    fn MatCreateVecs(matrix: Handle, right: *mut Handle, left: *mut Handle) -> Code;
    pub(crate) fn MatDestroy(matrix: *mut Handle) -> Code;
    fn VecGetArray(vector: Handle, values: *mut *mut f64) -> Code;
    fn VecRestoreArray(vector: Handle, values: *mut *mut f64) -> Code;
    fn VecSetBlockSize(vector: Handle, size: c_int) -> Code;
    fn VecDestroy(vector: *mut Handle) -> Code;
    fn KSPCreate(comm: MPI_Comm, solver: *mut Handle) -> Code;
    fn KSPSetType(solver: Handle, kind: *const c_char) -> Code;
    fn KSPSetNormType(solver: Handle, norm: c_int) -> Code;
    fn KSPSetTolerances(
        solver: Handle,
        relative: f64,
        absolute: f64,
        growth: f64,
        most: c_int,
    ) -> Code;
    fn KSPGetPC(solver: Handle, preconditioner: *mut Handle) -> Code;
    fn PCSetType(preconditioner: Handle, kind: *const c_char) -> Code;
    fn PCGetType(preconditioner: Handle, kind: *mut *const c_char) -> Code;
    fn KSPSetOperators(solver: Handle, matrix: Handle, of_preconditioner: Handle) -> Code;
    fn KSPSetFromOptions(solver: Handle) -> Code;
    fn KSPSolve(solver: Handle, b: Handle, x: Handle) -> Code;
    fn KSPGetConvergedReason(solver: Handle, reason: *mut c_int) -> Code;
    fn KSPGetIterationNumber(solver: Handle, iterations: *mut c_int) -> Code;
    fn KSPGetResidualNorm(solver: Handle, norm: *mut f64) -> Code;
    fn KSPDestroy(solver: *mut Handle) -> Code;
    fn KSPSetUp(solver: Handle) -> Code;
    fn PCMatApply(preconditioner: Handle, loads: Handle, motions: Handle) -> Code;
    fn MatCreateDense(
        comm: MPI_Comm,
        m: c_int,
        n: c_int,
        rows: c_int,
        columns: c_int,
        values: *mut f64,
        matrix: *mut Handle,
    ) -> Code;
    fn MatAssemblyBegin(matrix: Handle, kind: c_int) -> Code;
    fn MatAssemblyEnd(matrix: Handle, kind: c_int) -> Code;
}

/// `KSP_NORM_NATURAL`: of the residual in the norm of the preconditioner.
const NATURAL: c_int = 3;
/// `MAT_SPD`.
const POSITIVE_DEFINITE: c_int = 15;
/// `MAT_FINAL_ASSEMBLY`.
const FINAL: c_int = 0;
/// `PETSC_DECIDE`.
const DECIDE: c_int = -1;
/// `PETSC_DEFAULT` of a real number.
const DEFAULT: f64 = -2.0;
/// Iterations after which a solve has failed.
const MOST: c_int = 20_000;

/// PETSc from its beginning to its end.
pub(crate) struct Library;

/// Begins PETSc, after MPI.
pub(crate) fn begin() -> Result<Library, String> {
    // SAFETY: MPI has begun, and nothing has called PETSc yet.
    unsafe {
        // the program has handlers of its own
        let [name, value] = [c"-no_signal_handler", c"true"];
        told(PetscOptionsSetValue(
            null_mut(),
            name.as_ptr(),
            value.as_ptr(),
        ))?;
        told(PetscInitializeNoArguments())?;
        // errors are told by who called
        let silent = PetscReturnErrorHandler as *mut c_void;
        told(PetscPushErrorHandler(silent, null_mut()))?;
    }
    Ok(Library)
}

impl Drop for Library {
    fn drop(&mut self) {
        // SAFETY: all matrices are gone with the run.
        let _ = unsafe { PetscFinalize() };
    }
}

/// The error that a code tells.
pub(crate) fn told(code: Code) -> Result<(), String> {
    if code == 0 {
        return Ok(());
    }
    let mut text: *const c_char = std::ptr::null();
    // SAFETY: PETSc gives a text of its own, which stays, or none.
    let text = unsafe {
        let _ = PetscErrorMessage(code, &raw mut text, null_mut());
        match text.is_null() {
            true => format!("error {code}"),
            false => CStr::from_ptr(text).to_string_lossy().into_owned(),
        }
    };
    // mostly they name what PETSc does not have
    Err(match std::env::var("PETSC_OPTIONS") {
        Ok(options) if !options.is_empty() => format!("PETSc: {text} (PETSC_OPTIONS: {options})"),
        _ => format!("PETSc: {text}"),
    })
}

/// A symmetric positive definite matrix whose rows ranks share, with its solver.
pub struct Solver {
    ranks: Ranks,
    starts: Vec<usize>,
    matrix: Handle,
    solver: Handle,
    x: Handle,
    b: Handle,
    /// Whether the preconditioner is a factor.
    factored: bool,
}

// SAFETY: a run moves to another thread as a whole; the thread that steps is the one that calls PETSc.
unsafe impl Send for Solver {}
// SAFETY: nothing calls PETSc through a shared reference.
unsafe impl Sync for Solver {}

impl Solver {
    /// The solver of a matrix of which each rank gives its rows.
    ///
    /// # Errors
    /// What PETSc says.
    pub fn new(ranks: &Ranks, rows: &OwnRows) -> Result<Solver, String> {
        let mut engine = Solver {
            ranks: ranks.clone(),
            starts: rows.starts.to_vec(),
            matrix: null_mut(),
            solver: null_mut(),
            x: null_mut(),
            b: null_mut(),
            factored: false,
        };
        engine.make_matrix(rows)?;
        engine.add_rigid_motions(rows)?;
        engine.make_solver(rows.block)?;
        Ok(engine)
    }

    fn make_matrix(&mut self, rows: &OwnRows) -> Result<(), String> {
        let own = (rows.offsets.len() - 1) as c_int;
        let all = rows.starts.last().copied().unwrap_or(0) as c_int;
        // SAFETY: PETSc copies the three arrays, which are those of a compressed matrix of `own` rows.
        unsafe {
            told(MatCreate(PETSC_COMM_WORLD, &raw mut self.matrix))?;
            told(MatSetSizes(self.matrix, own, own, all, all))?;
            told(MatSetType(self.matrix, c"mpiaij".as_ptr()))?;
            told(MatSetBlockSize(self.matrix, rows.block as c_int))?;
            let [offsets, columns] = [rows.offsets.as_ptr(), rows.columns.as_ptr()];
            let values = rows.values.as_ptr();
            told(MatMPIAIJSetPreallocationCSR(
                self.matrix,
                offsets,
                columns,
                values,
            ))?;
            told(MatSetOption(self.matrix, POSITIVE_DEFINITE, 1))?;
            told(MatCreateVecs(self.matrix, &raw mut self.x, &raw mut self.b))
        }
    }

    /// The motions that multigrid is to know on coarse levels.
    fn add_rigid_motions(&mut self, rows: &OwnRows) -> Result<(), String> {
        if rows.places.is_empty() {
            return Ok(());
        }
        let mut space = null_mut();
        fill(self.x, &rows.places)?;
        // SAFETY: the vector has a coordinate for each row.
        unsafe {
            told(VecSetBlockSize(self.x, rows.block as c_int))?;
            told(MatNullSpaceCreateRigidBody(self.x, &raw mut space))?;
            told(MatSetNearNullSpace(self.matrix, space))?;
            told(MatNullSpaceDestroy(&raw mut space))
        }
    }

    fn make_solver(&mut self, block: usize) -> Result<(), String> {
        let mut preconditioner = null_mut();
        let kind = match block {
            1 => c"jacobi",
            _ => c"pbjacobi",
        };
        // SAFETY: the matrix is assembled.
        unsafe {
            told(KSPCreate(PETSC_COMM_WORLD, &raw mut self.solver))?;
            told(KSPSetOperators(self.solver, self.matrix, self.matrix))?;
            told(KSPSetType(self.solver, c"cg".as_ptr()))?;
            told(KSPSetNormType(self.solver, NATURAL))?;
            told(KSPGetPC(self.solver, &raw mut preconditioner))?;
            told(PCSetType(preconditioner, kind.as_ptr()))?;
            told(KSPSetFromOptions(self.solver))?;
            let mut kind = std::ptr::null();
            told(PCGetType(preconditioner, &raw mut kind))?;
            self.factored = !kind.is_null() && [c"cholesky", c"lu"].contains(&CStr::from_ptr(kind));
        }
        Ok(())
    }

    fn solve_own(
        &mut self,
        b: &[f64],
        x: &mut [f64],
        (tolerance, ended): (f64, &mut Unsolved),
    ) -> Result<(), String> {
        let own = self.starts[self.ranks.rank()]..self.starts[self.ranks.rank() + 1];
        fill(self.b, &b[own.clone()])?;
        let (mut reason, mut iterations) = (0, 0);
        // SAFETY: solver and vectors are those of the matrix.
        unsafe {
            told(KSPSetTolerances(
                self.solver,
                tolerance,
                DEFAULT,
                DEFAULT,
                MOST,
            ))?;
            told(KSPSolve(self.solver, self.b, self.x))?;
            told(KSPGetConvergedReason(self.solver, &raw mut reason))?;
            told(KSPGetIterationNumber(self.solver, &raw mut iterations))?;
            told(KSPGetResidualNorm(self.solver, &raw mut ended.residual))?;
        }
        ended.iterations = usize::try_from(iterations).unwrap_or(0);
        let solution = &mut x[own];
        let count = solution.len();
        with_entries(self.x, |entries| solution.copy_from_slice(entries), count)?;
        match reason > 0 {
            true => Ok(()),
            false => Err(format!("PETSc: reason {reason} of KSPConvergedReason")),
        }
    }
}

impl Engine for Solver {
    fn is_factor(&self) -> bool {
        self.factored
    }

    fn sweep(&mut self, loads: &mut [f64], count: usize) -> Result<(), String> {
        let all = self.starts.last().copied().unwrap_or(0);
        let own = self.starts[self.ranks.rank() + 1] - self.starts[self.ranks.rank()];
        let mut motions = vec![0.0; loads.len()];
        let [mut b, mut x] = [Dense(null_mut()), Dense(null_mut())];
        let mut preconditioner = null_mut();
        // SAFETY: both matrices have `count` columns of the own rows, in memory that outlives them.
        unsafe {
            for (matrix, values) in [(&mut b, &mut *loads), (&mut x, &mut motions)] {
                told(MatCreateDense(
                    PETSC_COMM_WORLD,
                    own as c_int,
                    DECIDE,
                    all as c_int,
                    count as c_int,
                    values.as_mut_ptr(),
                    &raw mut matrix.0,
                ))?;
                told(MatAssemblyBegin(matrix.0, FINAL))?;
                told(MatAssemblyEnd(matrix.0, FINAL))?;
            }
            told(KSPSetUp(self.solver))?;
            told(KSPGetPC(self.solver, &raw mut preconditioner))?;
            told(PCMatApply(preconditioner, b.0, x.0))?;
        }
        drop((b, x));
        loads.copy_from_slice(&motions);
        Ok(())
    }

    fn solve(&mut self, b: &[f64], x: &mut [f64], tolerance: f64) -> Result<usize, Unsolved> {
        let mut ended = Unsolved {
            iterations: 0,
            residual: f64::NAN,
            cause: String::new(),
        };
        let taken = self.solve_own(b, x, (tolerance, &mut ended));
        self.ranks.gather(x, &self.starts);
        match taken {
            Ok(()) => Ok(ended.iterations),
            Err(cause) => Err(Unsolved { cause, ..ended }),
        }
    }
}

/// Columns whose rows ranks share.
struct Dense(Handle);

impl Drop for Dense {
    fn drop(&mut self) {
        // SAFETY: it is PETSc's own or null.
        let _ = unsafe { MatDestroy(&raw mut self.0) };
    }
}

impl Drop for Solver {
    fn drop(&mut self) {
        // SAFETY: each is PETSc's own or null.
        unsafe {
            for vector in [&raw mut self.x, &raw mut self.b] {
                let _ = VecDestroy(vector);
            }
            let _ = KSPDestroy(&raw mut self.solver);
            let _ = MatDestroy(&raw mut self.matrix);
        }
    }
}

/// Writes the own entries of a vector.
fn fill(vector: Handle, values: &[f64]) -> Result<(), String> {
    with_entries(
        vector,
        |entries| entries.copy_from_slice(values),
        values.len(),
    )
}

fn with_entries(vector: Handle, work: impl FnOnce(&mut [f64]), count: usize) -> Result<(), String> {
    let mut entries = null_mut();
    // SAFETY: the vector has `count` own entries, which nobody else looks at until they are given back.
    unsafe {
        told(VecGetArray(vector, &raw mut entries))?;
        if count > 0 {
            work(std::slice::from_raw_parts_mut(entries, count));
        }
        told(VecRestoreArray(vector, &raw mut entries))
    }
}
