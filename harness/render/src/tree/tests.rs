//! The tree against every segment one by one.
