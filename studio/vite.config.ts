import { defineConfig } from "vitest/config";

// The server embeds dist/ as it stands and serves it under a policy without inline script or style: nothing is inlined.
export default defineConfig({
    base: "./",
    oxc: { jsx: { runtime: "automatic", importSource: "preact" } },
    build: {
        target: "es2022",
        assetsInlineLimit: 0,
        modulePreload: { polyfill: false },
        chunkSizeWarningLimit: 1200,
        reportCompressedSize: true,
    },
    server: { host: "127.0.0.1" },
    test: { include: ["test/**/*.test.ts"], environment: "node" },
});
