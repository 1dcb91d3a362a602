//! What is prepared over the ground of a model: with one albedo, or with one for each wavelength.

mod aerial_perspective;
mod colours;
mod sky;
