//! The C interface of vox as it is. The crate `voxtet` is the safe one over it, and needs no `unsafe` of its users.
//!
//! Everything here is generated from the C headers, with their comments. Enumerations are integers: a later library may
//! have more values of them.
#![no_std]
#![allow(non_camel_case_types)]

#[rustfmt::skip]
mod generated;
pub use generated::*;
