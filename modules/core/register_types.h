#pragma once

// Nothing to register: core holds only what the others are made of.
