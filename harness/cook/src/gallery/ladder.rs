//! The ladders' plots and tables, in the page's own colours, and the pictures of their rungs.
