#pragma once

// Nothing to register: techniques and filters come from their own modules.
