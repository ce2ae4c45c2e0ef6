import { defineConfig } from "vite";

// One script and one style, which `report/src/html` puts into every page.
export default defineConfig({
  build: {
    lib: { entry: "src/main.ts", formats: ["iife"], name: "paracosm", fileName: () => "page.js", cssFileName: "page" },
    outDir: "dist",
    emptyOutDir: true,
    minify: true,
    target: "es2022",
  },
});
