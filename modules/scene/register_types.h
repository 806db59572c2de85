#pragma once

// Nothing to register: nodes are made by whoever reads a file, and found by their class.
