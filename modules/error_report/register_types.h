#pragma once

// This module registers nothing: the command line calls its functions.
