#pragma once

// Registers nothing: core only contains utilities for the other modules.
