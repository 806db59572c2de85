#pragma once

/// Runs the tests that doctest's arguments select and returns the exit code: 0 if all passed. Used
/// by the test program, and by the library that runs the tests inside Godot.
int run_tests(int p_argument_count, char **p_arguments);
