#pragma once

// The build requires this file in every module. Nothing to register: callers create graphs
// directly.
