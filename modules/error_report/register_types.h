#pragma once

// Nothing to register: functions that the command line calls.
