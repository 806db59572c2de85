#pragma once

// Nothing to register: file readers create nodes and find them by class.
