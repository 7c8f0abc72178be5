//! FLIP against closed forms and against the published implementation.

mod closed_form;
mod published;
