//! Runs the shaders on a device and compares with the library; translates them and compares with what is stored.

mod air;
mod common;
mod disc;
mod layout;
mod picture;
mod readme;
mod sampler;
mod sky;
mod translations;
mod volume;
