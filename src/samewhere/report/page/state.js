// What is shown now, shared by the parts of the page. A part sets a value; those that depend on it
// are told.
(function () {
  class State {
    constructor(values) {
      this.values = values;
      this.listeners = {};
    }
    get(name) { return this.values[name]; }
    set(name, value) {
      if (this.values[name] === value) return;
      this.values[name] = value;
      (this.listeners[name] || []).forEach((listener) => listener(value));
    }
    // Calls listener whenever the value changes.
    onChange(name, listener) {
      (this.listeners[name] = this.listeners[name] || []).push(listener);
    }
    // The same, and now.
    watch(name, listener) {
      this.onChange(name, listener);
      listener(this.values[name]);
    }
  }
  samewhere.State = State;

  samewhere.byId = (id) => document.getElementById(id);
  // An element with attributes and children; text is never read as HTML.
  samewhere.element = function (tag, attributes = {}, ...children) {
    const node = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) {
      if (name === 'class') node.className = value;
      else if (name.startsWith('on')) node.addEventListener(name.slice(2), value);
      else if (value !== null && value !== false) node.setAttribute(name, value === true ? '' : value);
    }
    node.append(...children.filter((child) => child !== null && child !== undefined));
    return node;
  };
  // A number with as many digits as are worth reading.
  samewhere.number = function (value) {
    if (value === null || value === undefined || !Number.isFinite(value)) return '–';
    const size = Math.abs(value);
    if (Number.isInteger(value) || size >= 1000) return Math.round(value).toLocaleString('en-US').replace(/,/g, '\u202f');
    return value.toFixed(size >= 100 ? 0 : size >= 10 ? 1 : size >= 0.1 ? 2 : 3);
  };
})();
