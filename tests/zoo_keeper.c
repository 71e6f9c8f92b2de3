// Writes the zoo of awkward meshes, prints a line for each (path, expected exit code, word of the message; tabs between), and
// keeps them until its standard input ends.
#include "support/zoo.h"

#include <stdio.h>

int main(void)
{
    zoo all;
    zoo_open(&all);
    for (int k = 0; k < all.count; ++k)
        printf("%s\t%d\t%s\n", all.animals[k].path, (int)all.animals[k].expected,
               all.animals[k].word ? all.animals[k].word : "");
    fclose(stdout);
    while (getchar() != EOF)
        continue;
    zoo_close(&all);
    return 0;
}
