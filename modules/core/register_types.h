#pragma once

// The build requires this file in every module. Core registers nothing: it only contains utilities
// for the other modules.
