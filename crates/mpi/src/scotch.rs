//! The parts of a graph by PT-Scotch (Chevalier and Pellegrini, 2008), which PETSc calls, in one process.

#![allow(
    unsafe_code,
    reason = "functions of a C library; each call passes pointers that live as long as it does"
)]

use std::ffi::{c_char, c_int, c_void};
use std::ptr::null_mut;

use mpi::ffi::{MPI_Comm, RSMPI_COMM_SELF};

use crate::petsc::{Code, Handle, MatDestroy, told};
use carom_ranks::Graph;

unsafe extern "C" {
    fn PetscMallocA(
        count: c_int,
        clear: c_int,
        line: c_int,
        function: *const c_char,
        file: *const c_char,
        bytes: usize,
        room: *mut *mut c_void,
        ...
    ) -> Code;
    fn MatCreateMPIAdj(
        comm: MPI_Comm,
        rows: c_int,
        all: c_int,
        offsets: *mut c_int,
        columns: *mut c_int,
        values: *mut c_int,
        matrix: *mut Handle,
    ) -> Code;
    fn MatPartitioningCreate(comm: MPI_Comm, parts: *mut Handle) -> Code;
    fn MatPartitioningSetNParts(parts: Handle, count: c_int) -> Code;
    fn MatPartitioningSetAdjacency(parts: Handle, graph: Handle) -> Code;
    fn MatPartitioningSetType(parts: Handle, kind: *const c_char) -> Code;
    fn MatPartitioningSetVertexWeights(parts: Handle, weights: *const c_int) -> Code;
    fn MatPartitioningSetFromOptions(parts: Handle) -> Code;
    fn MatPartitioningApply(parts: Handle, found: *mut Handle) -> Code;
    fn MatPartitioningDestroy(parts: *mut Handle) -> Code;
    fn ISGetIndices(set: Handle, indices: *mut *const c_int) -> Code;
    fn ISRestoreIndices(set: Handle, indices: *mut *const c_int) -> Code;
    fn ISDestroy(set: *mut Handle) -> Code;
}

/// The part of each element, of `count` parts, by PT-Scotch, or by what `-mat_partitioning_type` of `PETSC_OPTIONS` says, in which elements of
/// different parts share few faces.
///
/// # Errors
/// What PETSc says.
pub fn parts(graph: &Graph, count: usize) -> Result<Vec<u32>, String> {
    let found = Partitioning::default().apply(graph, count)?;
    Ok(found.into_iter().map(|part| part as u32).collect())
}

/// What PETSc has made for a partition.
struct Partitioning {
    graph: Handle,
    parts: Handle,
    found: Handle,
}

impl Default for Partitioning {
    fn default() -> Partitioning {
        Partitioning {
            graph: null_mut(),
            parts: null_mut(),
            found: null_mut(),
        }
    }
}

impl Partitioning {
    /// The parts of the elements.
    fn apply(&mut self, graph: &Graph, count: usize) -> Result<Vec<c_int>, String> {
        let all = graph.weights.len();
        let mut parts = Vec::with_capacity(all);
        let mut indices: *const c_int = std::ptr::null();
        // SAFETY: the arrays are PETSc's, which takes them over; the set has an index for each element, which stay until they are given
        // back.
        unsafe {
            told(MatCreateMPIAdj(
                RSMPI_COMM_SELF,
                all as c_int,
                all as c_int,
                given(&graph.offsets)?,
                given(&graph.neighbours)?,
                null_mut(),
                &raw mut self.graph,
            ))?;
            told(MatPartitioningCreate(RSMPI_COMM_SELF, &raw mut self.parts))?;
            told(MatPartitioningSetAdjacency(self.parts, self.graph))?;
            told(MatPartitioningSetNParts(self.parts, count as c_int))?;
            told(MatPartitioningSetType(self.parts, c"ptscotch".as_ptr()))?;
            let weights = given(&graph.weights)?;
            told(MatPartitioningSetVertexWeights(self.parts, weights))?;
            told(MatPartitioningSetFromOptions(self.parts))?;
            told(MatPartitioningApply(self.parts, &raw mut self.found))?;
            told(ISGetIndices(self.found, &raw mut indices))?;
            if all > 0 {
                parts.extend_from_slice(std::slice::from_raw_parts(indices, all));
            }
            told(ISRestoreIndices(self.found, &raw mut indices))?;
        }
        Ok(parts)
    }
}

impl Drop for Partitioning {
    fn drop(&mut self) {
        // SAFETY: each is PETSc's own or null.
        unsafe {
            let _ = ISDestroy(&raw mut self.found);
            let _ = MatPartitioningDestroy(&raw mut self.parts);
            let _ = MatDestroy(&raw mut self.graph);
        }
    }
}

/// A copy of some numbers that PETSc frees.
fn given(numbers: &[i32]) -> Result<*mut c_int, String> {
    let mut room: *mut c_void = null_mut();
    // PETSc gives no room of no bytes
    let bytes = size_of_val(numbers).max(size_of::<c_int>());
    let place = [c"given".as_ptr(), c"scotch.rs".as_ptr()];
    // SAFETY: the room is as large as the numbers, and nobody else knows of it.
    unsafe {
        told(PetscMallocA(
            1,
            0,
            line!() as c_int,
            place[0],
            place[1],
            bytes,
            &raw mut room,
        ))?;
        std::ptr::copy_nonoverlapping(numbers.as_ptr(), room.cast(), numbers.len());
    }
    Ok(room.cast())
}
