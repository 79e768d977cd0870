"""A JSON Schema as a page in Markdown: one section for each table of the file, with its keys, types and meanings."""
import json
import re


def plain(text):
    """Text without meaning in Markdown; pieces in backticks stay code."""
    parts = text.split("`")
    for i in range(0, len(parts), 2):
        parts[i] = re.sub(r"([\\*_<>\[\]|$#{}])", r"\\\1", parts[i])
    return "`".join(parts).replace("\n", " ")


def anchor(heading):
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


class Page:
    def __init__(self, schema):
        self.schema = schema
        self.definitions = schema.get("definitions", {})

    def resolved(self, node):
        """The definition that a node refers to, with the node's own description."""
        if not node.get("$ref", "").startswith("#/definitions/"):
            return node
        target = self.definitions[node["$ref"].rsplit("/", 1)[1]]
        return {**self.resolved(target), **{k: v for k, v in node.items() if k != "$ref"}}

    def is_table(self, node):
        node = self.resolved(node)
        return "properties" in node or any("properties" in self.resolved(one) for one in node.get("oneOf", []))

    def type_of(self, node, name):
        if "$ref" in node and not node["$ref"].startswith("#"):
            return f"the schema `{node['$ref']}`"
        if "$ref" in node and self.is_table(node):
            section = node["$ref"].rsplit("/", 1)[1]
            return f"[{plain(section)}](#{anchor(section)})"
        if "$ref" in node:
            name = node["$ref"].rsplit("/", 1)[1]
        node = self.resolved(node)
        if "const" in node:
            return f"`{json.dumps(node['const'])}`"
        if "enum" in node:
            return ", ".join(f"`{json.dumps(value)}`" for value in node["enum"])
        for key in ("anyOf", "oneOf"):
            if key in node and "type" not in node and not self.is_table(node):
                return " or ".join(dict.fromkeys(self.type_of(one, name) for one in node[key]))
        if self.is_table(node):
            return f"[{plain(name)}](#{anchor(name)})"
        if node.get("type") == "array" and isinstance(node.get("items"), dict):
            count = f"{node['minItems']} " if node.get("minItems") == node.get("maxItems", -1) else ""
            items = re.sub(r"^(number|string|integer|boolean|array)\b", r"\1s", self.type_of(node["items"], name))
            return f"array of {count}{items}"
        kind = node.get("type", "any")
        kind = " or ".join(kind) if isinstance(kind, list) else kind
        limits = [f"{sign} {node[key]}" for key, sign in
                  (("exclusiveMinimum", ">"), ("minimum", "≥"), ("exclusiveMaximum", "<"), ("maximum", "≤")) if key in node]
        return " ".join([kind, *limits])

    def inner_tables(self, node, name):
        """Tables without a name of their own, below this node."""
        if "$ref" in node:
            return
        if self.is_table(node):
            yield name, node
        elif isinstance(node.get("items"), dict):
            yield from self.inner_tables(node["items"], name)
        else:
            for one in [*node.get("anyOf", []), *node.get("oneOf", [])]:
                yield from self.inner_tables(one, name)
        if isinstance(node.get("additionalProperties"), dict) and "properties" not in node:
            yield from self.inner_tables(node["additionalProperties"], name)

    def keys(self, node, name):
        required = set(node.get("required", []))
        lines = ["| Key | Type | Meaning |", "|---|---|---|"]
        below = []
        for key, value in node["properties"].items():
            path = f"{name}.{key}" if name else key
            meaning = plain(self.resolved(value).get("description", ""))
            if key in required:
                meaning = f"Required. {meaning}"
            lines.append(f"| `{key}` | {self.type_of(value, path)} | {meaning} |")
            below += self.inner_tables(value, path)
        return "\n".join(lines) + "\n\n", below

    def variant_name(self, node):
        properties = node["properties"]
        for key in ("type", "call", "ok", "kind", "status"):
            if "const" in properties.get(key, {}):
                return f"`{key} = {json.dumps(properties[key]['const'])}`"
        return "Keys: " + ", ".join(f"`{key}`" for key in properties)

    def section(self, name, node):
        node = self.resolved(node)
        text = f"## {plain(name)}\n\n" if name else ""
        if "description" in node:
            text += plain(node["description"]) + "\n\n"
        below = []
        if "properties" in node:
            table, below = self.keys(node, name)
            text += table
        for one in node.get("oneOf", []):
            one = self.resolved(one)
            if "properties" not in one:
                continue
            table, more = self.keys(one, name)
            text += f"{self.variant_name(one)}\n\n{table}"
            below += more
        seen = set()
        for path, inner in below:
            if path not in seen:
                seen.add(path)
                text += self.section(path, inner)
        return text

    def text(self, title):
        out = f"# {title}\n\n" + self.section("", self.schema)
        for name, node in self.definitions.items():
            for path, inner in [(name, node)] if "$ref" in node else self.inner_tables(node, name):
                out += self.section(path, inner) if self.is_table(inner) else ""
        return out


def schema_page(path, title):
    with open(path, encoding="utf-8") as file:
        return Page(json.load(file)).text(title)
