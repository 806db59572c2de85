#pragma once

// Nothing to register: whoever edits makes its watcher.
