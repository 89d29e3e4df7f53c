//! The show of Lúč as a library, so that tests and tools render what the player plays.
pub mod show;
