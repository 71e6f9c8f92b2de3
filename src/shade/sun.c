#include "ax/shade.h"

#include "base/vec.h"

#include <math.h>

static const double degree = AX_PI / 180;

// Days from noon of 1 January 2000 to the instant, by the day number of Fliegel and van Flandern (1968).
static double days_since_2000(ax_instant t)
{
    int a = (t.month - 14) / 12;
    long day = 1461L * (t.year + 4800 + a) / 4 + 367L * (t.month - 2 - 12 * a) / 12 -
               3L * ((t.year + 4900 + a) / 100) / 4 + t.day - 32075;
    return (double)(day - 2451545) - 0.5 + t.hours / 24;
}

ax_sun ax_sun_at(double latitude, double longitude, ax_instant t)
{
    double n = days_since_2000(t);
    double anomaly = (357.528 + 0.9856003 * n) * degree;
    double ecliptic = (280.460 + 0.9856474 * n) * degree + (1.915 * sin(anomaly) + 0.020 * sin(2 * anomaly)) * degree;
    double obliquity = (23.439 - 0.0000004 * n) * degree;
    double ascension = atan2(cos(obliquity) * sin(ecliptic), cos(ecliptic));
    double declination = asin(sin(obliquity) * sin(ecliptic));
    double sidereal = fmod(6.697375 + 0.0657098242 * n + t.hours, 24) * 15 * degree; // at Greenwich
    double hour = sidereal + longitude * degree - ascension, phi = latitude * degree;
    // up, north and east parts of the unit vector to the sun: no case is singular
    double up = sin(phi) * sin(declination) + cos(phi) * cos(declination) * cos(hour);
    double north = cos(phi) * sin(declination) - sin(phi) * cos(declination) * cos(hour);
    double east = -cos(declination) * sin(hour);
    double azimuth = atan2(east, north);
    return (ax_sun){azimuth < 0 ? azimuth + 2 * AX_PI : azimuth, atan2(up, hypot(north, east))};
}

ax_ray ax_sun_ray(ax_sun sun, double north)
{
    double up = sin(sun.elevation), level = cos(sun.elevation), from_y = sun.azimuth - north;
    ax_ray ray = {.to_sun = {level * sin(from_y), level * cos(from_y), up}};
    if (up > 0) {
        double height = sun.elevation / degree;
        double mass = 1 / (up + 0.50572 * pow(height + 6.07995, -1.6364));
        ray.weight = 1353 * pow(0.7, pow(mass, 0.678)) * up;
    }
    return ray;
}

int ax_sun_day(double latitude, double longitude, double north, ax_instant t, double hours, int count, ax_ray* rays)
{
    int kept = 0;
    for (int k = 0; k < count; ++k) {
        ax_instant at = t;
        at.hours += hours * (k + 0.5) / count;
        ax_ray ray = ax_sun_ray(ax_sun_at(latitude, longitude, at), north);
        if (ray.weight > 0)
            rays[kept++] = ray;
    }
    return kept;
}
