//! Tests of the ladders, and of what their rungs draw.

mod allowance;
mod cdrf;
mod cost;
mod deferred;
mod diffusion;
mod footprint;
mod gem;
mod lamp_inside;
mod reference;
mod surroundings;
