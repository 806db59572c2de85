#pragma once

// Registers nothing: callers create a Window directly.
