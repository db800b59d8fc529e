// Elements of the page.

export function byId<T extends HTMLElement = HTMLElement>(id: string): T {
  const element = document.getElementById(id);
  if (!element) throw new Error(`the page has no element ${id}`);
  return element as T;
}

/// Names on the left, values on the right.
export function dictionary(rows: [string, string][]): HTMLElement {
  const list = document.createElement("dl");
  for (const [name, value] of rows) {
    const term = document.createElement("dt");
    const description = document.createElement("dd");
    term.textContent = name;
    description.textContent = value;
    list.append(term, description);
  }
  return list;
}

/// One thing that went wrong, in words, until it is closed or right again.
export class Message {
  private subject = "";

  constructor(private readonly place: HTMLElement) {
    place.querySelector("button")?.addEventListener("click", () => (place.hidden = true));
  }

  get visible(): boolean {
    return !this.place.hidden;
  }

  show(subject: string, words: string): void {
    this.subject = subject;
    const text = this.place.querySelector("p");
    if (text) text.textContent = words.charAt(0).toUpperCase() + words.slice(1);
    this.place.hidden = false;
  }

  /// Only what is about `subject`.
  clear(subject: string): void {
    if (this.subject === subject) this.place.hidden = true;
  }
}
