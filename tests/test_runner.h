#pragma once

/// Runs the tests that doctest's arguments choose; the exit code. For the test program, and for the
/// library that runs them inside Godot.
int run_tests(int p_argument_count, char **p_arguments);
