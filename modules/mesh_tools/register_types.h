#pragma once

// The module registers no types: it has only functions and classes that other modules call.
