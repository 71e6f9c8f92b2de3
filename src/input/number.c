#include "input/number.h"

#include <stdbool.h>
#include <stdlib.h>

static const char* skip_digits(const char* at)
{
    while (*at >= '0' && *at <= '9')
        ++at;
    return at;
}

const char* ax_number_read(const char* at, double* value)
{
    const char* start = at;
    at += *at == '+' || *at == '-';
    const char* whole = at;
    at = skip_digits(at);
    bool digits = at > whole;
    if (*at == '.') {
        const char* fraction = at + 1;
        at = skip_digits(fraction);
        digits = digits || at > fraction;
    }
    if (!digits)
        return NULL;
    if (*at == 'e' || *at == 'E') {
        const char* exponent = at + 1 + (at[1] == '+' || at[1] == '-');
        if (skip_digits(exponent) > exponent)
            at = skip_digits(exponent);
    }
    bool prefix = at == whole + 1 && *whole == '0' && (*at == 'x' || *at == 'X'); // strtod would take 0x10 as a whole
    *value = prefix ? 0 : strtod(start, NULL);
    return at;
}
