//! Facts about factorisations, on systems large enough to show them.

mod block;
mod factor;
mod respond;
