// Names for what the theme leaves to icons, so that they can be heard.
addEventListener("DOMContentLoaded", () => {
  for (const button of document.querySelectorAll(".search-button-field"))
    button.setAttribute("aria-label", button.textContent.replace(/\s+/g, " ").trim() || "Search");
  for (const summary of document.querySelectorAll("nav summary")) {
    const link = summary.closest("li")?.querySelector("a");
    summary.setAttribute("aria-label", `pages of ${link ? link.textContent.trim() : "this section"}`);
  }
});
