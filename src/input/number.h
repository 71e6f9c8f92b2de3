// Decimal numbers in text, as formulas and drawings write them: no hexadecimal, no inf, no nan.
#pragma once

// Reads an unsigned or signed number at `at`; the text is zero-terminated. Returns what follows it, or NULL if there is none there.
// Too large ones become infinite.
const char* ax_number_read(const char* at, double* value);
