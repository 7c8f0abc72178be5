//! Diagrams of the techniques that are geometry, drawn from the cookbook's own functions.
