//! Property rows of every function, for "edit this function and check it" in the browser.
