#pragma once

// Nothing to register: file readers create the nodes, which are then found by their class.
