#pragma once

// This module registers nothing; the module main calls its functions.
