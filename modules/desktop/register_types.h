#pragma once

// The build requires this file in every module. Desktop registers nothing: callers create a Window
// directly.
