//! All integration tests in one program, so that it is linked once.

mod bad_input;
mod command_line;
mod example_scenes;
mod formats;
mod model;
mod real_scenes;
mod robustness;
mod support;
