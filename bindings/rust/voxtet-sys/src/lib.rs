//! The C interface of vox as it is. The crate `voxtet` is the safe one over it, and needs no `unsafe` of its users.
//!
//! Everything here is generated from the C headers, with their comments. Enumerations are integers: a later library may
//! have more values of them. A struct with a `struct_size` begins as its size and zeros, which are the defaults, except for
//! what `vox_default_X` of `vox_sim.h` sets.
#![no_std]
#![allow(non_camel_case_types)]

#[rustfmt::skip]
mod generated;
pub use generated::*;
