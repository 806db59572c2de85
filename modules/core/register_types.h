#pragma once

// Nothing to register: core has only building blocks for the other modules.
