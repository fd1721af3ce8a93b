//! Finds PETSc of the operating system, for the feature `petsc`.

// A build script has nobody but cargo to tell what it found.
#![allow(clippy::print_stdout)]

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    #[cfg(feature = "petsc")]
    if let Err(error) = pkg_config::Config::new()
        .atleast_version("3.15")
        .probe("PETSc")
    {
        println!("cargo:warning=PETSc is not found; `.ci/install-mpi` installs it: {error}");
    }
}
